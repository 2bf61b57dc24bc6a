/* SPDX-License-Identifier: Apache-2.0 */
/* Random numbers by position: the same seed and index give the same number, in any order, on every machine. */
#ifndef TRIM3R_TOOLS_STRESS_RANDOM_H
#define TRIM3R_TOOLS_STRESS_RANDOM_H

#include <stdint.h>

#include "core/fixed.h"

static inline uint32_t stress_random(uint32_t seed, uint32_t index)
{
    return t3r_mix32(t3r_mix32(seed) + index * 0x9e3779b1u);
}

/* [0, 1) */
static inline double stress_uniform(uint32_t seed, uint32_t index)
{
    return stress_random(seed, index) * 0x1p-32;
}

/* Mean 0, deviation 1, near normal: four uniform numbers added, so within 3.47. */
static inline double stress_normal(uint32_t seed, uint32_t index)
{
    uint32_t a = stress_random(seed, 2 * index), b = stress_random(seed, 2 * index + 1);
    double sum = (double)(a & 65535u) + (double)(a >> 16) + (double)(b & 65535u) + (double)(b >> 16);
    return (sum - 131070) * (1.7320508075688772 / 65536);
}

#endif
