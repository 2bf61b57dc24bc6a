#include "path_step.h"

#include <stddef.h>

static inline uint8_t minimum(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

/* What a path adds to the cost: the values of the pixel before at k - 1, k and k + 1. */
static inline uint8_t relaxed(uint8_t below, uint8_t same, uint8_t above, uint8_t least, uint8_t p1, uint8_t p2)
{
    uint8_t beside = (uint8_t)(minimum(below, above) + p1);
    return minimum((uint8_t)(minimum(same, beside) - least), p2);
}

/* The three pointers are into one slot; a compiler that saw it would carry values from step to step, and then not
 * vectorize. */
static __attribute__((noinline)) uint8_t follow(const uint8_t *cost, const uint8_t *below, const uint8_t *same,
                                                const uint8_t *above, uint8_t from_least, uint8_t p1, uint8_t p2,
                                                size_t count, uint8_t *restrict to)
{
    uint8_t least = UINT8_MAX;
    for (size_t k = 0; k < count; k++) {
        uint8_t value = (uint8_t)(cost[k] + relaxed(below[k], same[k], above[k], from_least, p1, p2));
        to[k] = value;
        least = minimum(least, value);
    }
    return least;
}

/* Two paths, or all four. */
static void sum_two(const uint8_t *a, const uint8_t *b, size_t count, bool add, int16_t *restrict sums)
{
    for (size_t k = 0; k < count; k++) {
        sums[k] = (int16_t)((add ? sums[k] : 0) + (int16_t)(a[k] + b[k]));
    }
}

static void sum_four(const uint8_t *a, const uint8_t *b, const uint8_t *c, const uint8_t *d, size_t count, bool add,
                     int16_t *restrict sums)
{
    for (size_t k = 0; k < count; k++) {
        int16_t sum = (int16_t)((int16_t)(a[k] + b[k]) + (int16_t)(c[k] + d[k]));
        sums[k] = (int16_t)((add ? sums[k] : 0) + sum);
    }
}

void t3r_path_step_c(const uint8_t *cost, t3r_path_link *links, uint32_t paths, uint8_t p1, uint32_t count, bool add,
                     int16_t *sums)
{
    count &= ~(T3R_PATH_LANES - 1); /* a multiple already; this says so to compilers */
    for (uint32_t path = 0; path < paths; path++) {
        t3r_path_link *l = &links[path];
        l->least = follow(cost, l->from, l->from + 1, l->from + 2, l->from_least, p1, l->p2, count, l->to);
    }
    if (sums != NULL && paths == 4) {
        sum_four(links[0].to, links[1].to, links[2].to, links[3].to, count, add, sums);
    } else if (sums != NULL) {
        sum_two(links[0].to, links[1].to, count, add, sums);
    }
}
