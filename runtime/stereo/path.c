/* SPDX-License-Identifier: Apache-2.0 */
#include "path.h"

#include "core/fixed.h"
#include "kernels/census.h"

t3r_path_costs t3r_path_costs_of(uint32_t p1, uint32_t p2, uint32_t p2_min)
{
    t3r_path_costs costs = {.p1 = (uint8_t)p1, .guard = (uint8_t)(p2 + T3R_CENSUS_PAIRS)};
    for (uint32_t change = 0; change < T3R_PATH_PENALTIES; change++) {
        uint32_t lowered = p2 * 8 / (8 + change);
        costs.p2[change] = (uint8_t)T3R_MAX(lowered, p2_min);
    }
    return costs;
}

void t3r_path_begin(uint8_t *state, uint32_t width, uint32_t disparities, uint8_t guard)
{
    const size_t slots = (size_t)width + 2, pitch = (size_t)disparities + 1,
                 bytes = T3R_PATH_STATE_BYTES(width, disparities);
    for (size_t i = 0; i < bytes; i++) {
        state[i] = 0;
    }
    for (size_t i = 0; i <= slots; i++) {
        state[i * pitch] = guard;
    }
}
