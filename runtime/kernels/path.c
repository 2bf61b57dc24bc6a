#include "path.h"

#include "core/fixed.h"

t3r_path_costs t3r_path_costs_of(uint32_t same, uint32_t step, uint32_t least_step)
{
    t3r_path_costs costs = {.same = (uint8_t)same, .guard = (uint8_t)(step + T3R_CENSUS_PAIRS)};
    for (uint32_t change = 0; change < T3R_PATH_PENALTIES; change++) {
        uint32_t p2 = step * 8 / (8 + change);
        costs.step[change] = (uint8_t)T3R_MAX(p2, least_step);
    }
    return costs;
}

void t3r_path_begin(uint8_t *state, uint32_t width, uint32_t disparities, uint8_t guard)
{
    const size_t slots = (size_t)width + 2, pitch = (size_t)disparities + 1,
                 bytes = T3R_PATH_STATE_BYTES(width, disparities);
    for (size_t i = 0; i < bytes; i++) {
        state[i] = 0;
    }
    for (size_t i = 0; i <= slots; i++) {
        state[i * pitch] = guard;
    }
}

static inline uint8_t minimum(uint8_t a, uint8_t b)
{
    return a < b ? a : b;
}

/* A pixel along one path: the slot of the one before, its least, P2; where to, and the least of that. */
typedef struct link {
    const uint8_t *from;
    uint8_t *to;
    uint8_t from_least, step, least;
} link;

/* What a path adds to the cost: the values of the pixel before at k - 1, k and k + 1. */
static inline uint8_t relaxed(uint8_t below, uint8_t same_k, uint8_t above, uint8_t least, uint8_t step, uint8_t same)
{
    uint8_t beside = (uint8_t)(minimum(below, above) + same);
    return minimum((uint8_t)(minimum(same_k, beside) - least), step);
}

/* count here and below: a multiple of 16. The three pointers are into one slot; a compiler that saw it would carry
 * values from step to step, and then not vectorize. */
static __attribute__((noinline)) uint8_t follow(const uint8_t *cost, const uint8_t *below, const uint8_t *same_k,
                                                const uint8_t *above, uint8_t from_least, uint8_t step, uint8_t same,
                                                size_t count, uint8_t *restrict to)
{
    uint8_t least = UINT8_MAX;
    for (size_t k = 0; k < count; k++) {
        uint8_t value = (uint8_t)(cost[k] + relaxed(below[k], same_k[k], above[k], from_least, step, same));
        to[k] = value;
        least = minimum(least, value);
    }
    return least;
}

static void follow_link(const uint8_t *cost, link *path, uint8_t same, size_t count)
{
    const uint8_t *from = path->from;
    path->least = follow(cost, from, from + 1, from + 2, path->from_least, path->step, same, count, path->to);
}

/* The costs of a pixel's paths summed: a and d, or all four; added to what is there or not. */
static void sum_two(const uint8_t *a, const uint8_t *d, size_t count, bool add, int16_t *restrict sums)
{
    for (size_t k = 0; k < count; k++) {
        sums[k] = (int16_t)((add ? sums[k] : 0) + (int16_t)(a[k] + d[k]));
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

static uint8_t step_between(const t3r_path_costs *costs, uint8_t a, uint8_t b)
{
    return costs->step[a > b ? a - b : b - a];
}

/* sums NULL: the path along the row is left out. */
static void follow_row(const t3r_path_row *row, bool diagonals, bool reverse, int16_t *sums)
{
    const uint32_t width = row->width, count = row->disparities & ~(T3R_PATH_LANES - 1), paths = diagonals ? 3 : 1;
    const size_t pitch = (size_t)count + 1, state = T3R_PATH_STATE_BYTES(width, count);
    const size_t leasts = ((size_t)width + 2) * pitch + 1;
    const uint8_t same = row->costs->same;
    uint8_t beside[2][T3R_PATH_MOST + 2]; /* the path along the row: this pixel and the one before it */
    for (uint32_t k = 0; k < count + 2; k++) {
        beside[0][k] = beside[1][k] = k == 0 || k == count + 1 ? row->costs->guard : 0;
    }
    link links[4] = {0};
    for (uint32_t i = 0; i < width; i++) {
        const uint32_t x = reverse ? width - 1 - i : i;
        const uint8_t here = row->luma[x];
        /* Columns in the row before; slot x + 1 is pixel x, the slots at the ends are where paths begin. */
        const uint32_t column[3] = {x, x > 0 ? x - 1 : 0, T3R_MIN(x + 1, width - 1)};
        const size_t slot[3] = {(size_t)x + 1, x, (size_t)x + 2};
        for (uint32_t path = 0; path < paths; path++) {
            const uint8_t *from = row->from + path * state;
            links[path].from = from + slot[path] * pitch;
            links[path].from_least = from[leasts + slot[path]];
            links[path].step = step_between(row->costs, here, row->luma_before[column[path]]);
            links[path].to = row->to + path * state + ((size_t)x + 1) * pitch + 1;
        }
        links[3].from = beside[i & 1];
        links[3].to = beside[~i & 1] + 1;
        links[3].from_least = links[3].least; /* 0 in the beginning */
        links[3].step = step_between(row->costs, here, row->luma[i == 0 ? x : reverse ? x + 1 : x - 1]);

        const uint8_t *cost = row->cost + (size_t)x * count;
        int16_t *s = sums != NULL ? sums + (size_t)x * count : NULL;
        for (uint32_t path = 0; path < paths; path++) {
            follow_link(cost, &links[path], same, count);
            row->to[path * state + leasts + x + 1] = links[path].least;
        }
        if (s == NULL) {
            continue;
        }
        follow_link(cost, &links[3], same, count);
        if (diagonals) {
            sum_four(links[0].to, links[1].to, links[2].to, links[3].to, count, reverse, s);
        } else {
            sum_two(links[0].to, links[3].to, count, reverse, s);
        }
    }
}

void t3r_path_rows(const t3r_path_row *row, bool diagonals)
{
    follow_row(row, diagonals, false, NULL);
}

void t3r_path_sums(const t3r_path_row *row, bool diagonals, bool reverse, int16_t *sums)
{
    follow_row(row, diagonals, reverse, sums);
}
