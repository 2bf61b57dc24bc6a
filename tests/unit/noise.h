/* SPDX-License-Identifier: Apache-2.0 */
/* A small repeatable random generator. */
#ifndef T3R_TESTS_NOISE_H
#define T3R_TESTS_NOISE_H

#include <stdint.h>

#ifdef UNIT_RANDOM_IS_DRAWN
/* A fuzzer defines this itself, to read its input. */
uint64_t unit_random(uint64_t *state);
#else
/* splitmix64: the next 64 bits of the sequence */
static inline uint64_t unit_random(uint64_t *state)
{
    uint64_t z = *state += UINT64_C(0x9e3779b97f4a7c15);
    z = (z ^ (z >> 30)) * UINT64_C(0xbf58476d1ce4e5b9);
    z = (z ^ (z >> 27)) * UINT64_C(0x94d049bb133111eb);
    return z ^ (z >> 31);
}
#endif

/* low..high, both included */
static inline int64_t unit_between(uint64_t *state, int64_t low, int64_t high)
{
    return low + (int64_t)(unit_random(state) % (uint64_t)(high - low + 1));
}

#endif
