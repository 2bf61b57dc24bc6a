/* What the unit tests share: cmocka's includes and a small generator of repeatable noise. */
#ifndef T3R_TESTS_UNIT_H
#define T3R_TESTS_UNIT_H

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

#ifdef UNIT_RANDOM_IS_DRAWN
/* A fuzzer's own: what its input says. */
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

/* Exactly count x bytes, so that a sanitizer sees the first one beyond. */
static inline void *unit_array(size_t count, size_t bytes)
{
    void *memory = calloc(count, bytes);
    assert_non_null(memory);
    return memory;
}

#endif
