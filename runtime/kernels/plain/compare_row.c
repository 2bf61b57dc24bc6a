/* SPDX-License-Identifier: Apache-2.0 */
#include "core/fixed.h"
#include "core/gain.h"
#include "kernels/scatter.h"

void t3r_compare_row_c(const uint8_t *restrict shown, uint32_t spread, uint16_t gain_q14,
                       const uint16_t *restrict drawn_q7, uint32_t count, int16_t *restrict residual_q4)
{
    for (uint32_t i = 0; i < count; i++) {
        const int32_t drawn = T3R_MIN((int32_t)drawn_q7[i], 255 * 128);
        residual_q4[i] = (int16_t)t3r_round_shift32(t3r_level_q7(shown[i << spread] * 128u, gain_q14) - drawn, 3);
    }
}
