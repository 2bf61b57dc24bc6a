/* SPDX-License-Identifier: Apache-2.0 */
/* The budget's keys. */
#include "checks.h"
#include "core/fixed.h"
#include "guarded.h"

const char *check_wanted_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, 200), gamma_q8 = (uint32_t)any_value(seed, 0, 512);
    uint16_t *texture = guarded_take(count * sizeof *texture, 2), *wanted = guarded_take(count * sizeof *wanted, 2);
    for (uint32_t i = 0; i < count; i++) {
        texture[i] = (uint16_t)(unit_random(seed) % 2 == 0 ? unit_between(seed, 0, 300) : any_value(seed, 0, 65535));
    }
    kernels->wanted_row(texture, count, gamma_q8, wanted);
    for (uint32_t i = 0; i < count; i++) {
        const int64_t log_q16 = t3r_log2_q16(texture[i] + T3R_TEXTURE_FLOOR_Q4);
        if (wanted[i] != t3r_round_shift64(log_q16 * gamma_q8, 14)) {
            return "a wanted density differs";
        }
    }
    return NULL;
}

const char *check_key_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, T3R_KEY_RUN), noise_seed = (uint32_t)unit_random(seed);
    const uint32_t place = (uint32_t)unit_random(seed) & ~(T3R_KEY_RUN - 1);
    const bool is_white = unit_random(seed) % 3 == 0;
    uint16_t *rank = guarded_take(count * sizeof *rank, 2), *wanted = guarded_take(count * sizeof *wanted, 2);
    uint16_t *key = guarded_take(count * sizeof *key, 2);
    for (uint32_t i = 0; i < count; i++) {
        rank[i] = (uint16_t)(unit_random(seed) % 2 == 0 ? unit_between(seed, 0, 20) : any_value(seed, 0, 4095));
        wanted[i] = (uint16_t)any_value(seed, 0, 35000);
    }
    kernels->key_row(place, noise_seed, is_white ? NULL : rank, wanted, count, key);
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t noise = t3r_mix32((place + i) ^ noise_seed);
        const uint32_t threshold = is_white ? noise >> 16 : rank[i] * 16u + (noise >> 28);
        const int32_t log_q10 = t3r_round_shift32(t3r_log2_q16(2 * threshold + 1), 6) - (17 << 10);
        const int32_t relative = t3r_clamp32(T3R_KEY_ZERO + log_q10 - wanted[i], 16, UINT16_MAX);
        if (key[i] != (threshold < T3R_SURE_THRESHOLD ? (int32_t)(threshold >> 4) : relative)) {
            return "a key differs";
        }
    }
    return NULL;
}
