/* SPDX-License-Identifier: Apache-2.0 */
/* The loops of the radix sort, a byte a pass. Arrays are aligned to 4 bytes; nothing beyond `count` entries is read,
 * and only the entries that a pass fills are written. */
#ifndef T3R_KERNEL_RADIX_H
#define T3R_KERNEL_RADIX_H

#include <stdint.h>

#define T3R_RADIX_DIGITS 4
#define T3R_RADIX 256

/* Adds 1 to histogram[digit x 256 + value] for each digit of each key; digit 0 is the lowest byte. */
typedef void t3r_radix_count_kernel(const uint32_t *restrict keys, uint32_t count,
                                    uint32_t histogram[T3R_RADIX_DIGITS * T3R_RADIX]);

/* Moves (key, index) pairs, in order, to the places given by the start of their digit. start[value] then points after
 * the last pair with that value. The starts lead to `count` different places. */
typedef void t3r_radix_pass_kernel(const uint32_t *restrict keys, const uint32_t *restrict indices, uint32_t count,
                                   uint32_t digit, uint32_t start[T3R_RADIX], uint32_t *restrict to_keys,
                                   uint32_t *restrict to_indices);

t3r_radix_count_kernel t3r_radix_count_c;
t3r_radix_pass_kernel t3r_radix_pass_c;

#endif
