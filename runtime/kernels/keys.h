/* SPDX-License-Identifier: Apache-2.0 */
/* The budget's keys, a run of pixels at a time (SPEC.md, "Budget"). None of these pointers is aligned. */
#ifndef T3R_KERNEL_KEYS_H
#define T3R_KERNEL_KEYS_H

#include <stdbool.h>
#include <stdint.h>

/* Zero of keys, which are logarithms in Q10: the key of a point with blue noise 1 and wanted density 1. */
#define T3R_KEY_ZERO (50 << 10)
/* Maximum pixels of a run: the number of columns of the blue noise. */
#define T3R_KEY_RUN 64u
/* A pixel with a threshold (of 65536) below this, 0.003, is retained before all others, at any texture. */
#define T3R_SURE_THRESHOLD 197u
/* Added to the texture before its power, 0.002 of full scale, so that blank walls keep some points. */
#define T3R_TEXTURE_FLOOR_Q4 8u

/* Computes wanted = gamma log2(texture + floor), Q10, gamma at most 2 in Q8: below 35,000. */
typedef void t3r_wanted_row_kernel(const uint16_t *restrict texture_q4, uint32_t count, uint32_t gamma_q8,
                                   uint16_t *restrict wanted_q10);

/* Computes the keys of `count` pixels: log2 of the threshold, in [0, 65535], minus wanted. White noise of `place` + i
 * splits each of the 4,096 ranks of blue noise; without ranks (NULL) it is the whole threshold. The lowest bits of
 * `place`, which count within the run, are 0. */
typedef void t3r_key_row_kernel(uint32_t place, uint32_t seed, const uint16_t *rank,
                                const uint16_t *restrict wanted_q10, uint32_t count, uint16_t *restrict key);

t3r_wanted_row_kernel t3r_wanted_row_c;
t3r_key_row_kernel t3r_key_row_c;

#endif
