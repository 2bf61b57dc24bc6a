#include "kernels/path_row.h"

static inline uint8_t minimum(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

/* Returns what a path adds to the cost, from the previous pixel's values at k - 1, k and k + 1. */
static inline uint8_t relaxed(uint8_t below, uint8_t same, uint8_t above, uint8_t least, uint8_t p1, uint8_t p2)
{
    uint8_t beside = (uint8_t)(minimum(below, above) + p1);
    return minimum((uint8_t)(minimum(same, beside) - least), p2);
}

/* Not inlined: the three pointers are into one slot, and a compiler that sees this carries values from step to step
 * instead of vectorizing. */
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

/* Sum the values of two paths, and of all four. */
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

void t3r_path_row_c(const t3r_path_row *row)
{
    const uint32_t width = row->width, paths = row->diagonals ? 3 : 1;
    const uint32_t count = row->disparities & ~(T3R_PATH_LANES - 1); /* unchanged; shows compilers a multiple */
    const size_t pitch = (size_t)count + 1, state = T3R_PATH_STATE_BYTES(width, count);
    const size_t leasts = t3r_path_leasts(width, count);
    const uint8_t p1 = row->costs->p1;
    uint8_t beside[2][T3R_PATH_MOST + 2]; /* the path along the row: this pixel and the previous one */
    uint8_t least = 0;
    for (uint32_t k = 0; k < count + 2; k++) {
        beside[0][k] = beside[1][k] = k == 0 || k == count + 1 ? row->costs->guard : 0;
    }
    for (uint32_t i = 0; i < width; i++) {
        const uint32_t x = row->reverse ? width - 1 - i : i;
        const uint8_t *cost = row->cost + (size_t)x * count;
        uint8_t *values[T3R_PATH_LINKS];
        for (uint32_t path = 0; path < paths; path++) {
            const t3r_path_link l = t3r_path_link_of(row, path, x);
            uint8_t *to = row->to + path * state;
            values[path] = to + ((size_t)x + 1) * pitch + 1;
            to[leasts + x + 1] = follow(cost, l.from, l.from + 1, l.from + 2, l.least, p1, l.p2, count, values[path]);
        }
        if (row->sums == NULL) {
            continue;
        }
        const uint8_t *from = beside[i & 1];
        int16_t *sums = row->sums + (size_t)x * count;
        values[paths] = beside[~i & 1] + 1;
        least = follow(cost, from, from + 1, from + 2, least, p1, t3r_path_p2_along(row, x, i), count, values[paths]);
        if (paths == 3) {
            sum_four(values[0], values[1], values[2], values[3], count, row->reverse, sums);
        } else {
            sum_two(values[0], values[1], count, row->reverse, sums);
        }
    }
}
