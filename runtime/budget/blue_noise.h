/* SPDX-License-Identifier: Apache-2.0 */
/* A blue-noise threshold map: for any density, the pixels with ranks below it are evenly spread (SPEC, "Budget"). */
#ifndef T3R_BLUE_NOISE_H
#define T3R_BLUE_NOISE_H

#include <stdint.h>

#define T3R_BLUE_NOISE_SIDE 64u
/* 12 bits a rank, two ranks in three bytes, to save flash. */
#define T3R_BLUE_NOISE_BYTES (T3R_BLUE_NOISE_SIDE * T3R_BLUE_NOISE_SIDE / 2 * 3)

extern const uint8_t t3r_blue_noise_packed[T3R_BLUE_NOISE_BYTES];

/* Returns the rank, 0..4095, at a row and a column below T3R_BLUE_NOISE_SIDE; the map is periodic. */
static inline uint32_t t3r_blue_noise(uint32_t row, uint32_t column)
{
    const uint32_t place = row * T3R_BLUE_NOISE_SIDE + column;
    const uint8_t *pair = t3r_blue_noise_packed + place / 2 * 3;
    return place % 2 == 0 ? pair[0] | (pair[1] & 15u) << 8 : pair[1] >> 4 | (uint32_t)pair[2] << 4;
}

#endif
