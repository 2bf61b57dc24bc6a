#include "path.h"

#include "core/fixed.h"

t3r_path_costs t3r_path_costs_of(uint32_t p1, uint32_t p2, uint32_t p2_min)
{
    t3r_path_costs costs = {.p1 = (uint8_t)p1, .guard = (uint8_t)(p2 + T3R_CENSUS_PAIRS)};
    for (uint32_t change = 0; change < T3R_PATH_PENALTIES; change++) {
        uint32_t lowered = p2 * 8 / (8 + change);
        costs.p2[change] = (uint8_t)T3R_MAX(lowered, p2_min);
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

static uint8_t p2_between(const t3r_path_costs *costs, uint8_t a, uint8_t b)
{
    return costs->p2[a > b ? a - b : b - a];
}

/* sums NULL: the path along the row is left out. */
static void follow_row(const t3r_path_row *row, bool diagonals, bool reverse, int16_t *sums)
{
    const uint32_t width = row->width, count = row->disparities, paths = diagonals ? 3 : 1;
    const size_t pitch = (size_t)count + 1, state = T3R_PATH_STATE_BYTES(width, count);
    const size_t leasts = ((size_t)width + 2) * pitch + 1;
    uint8_t beside[2][T3R_PATH_MOST + 2]; /* the path along the row: this pixel and the one before it */
    for (uint32_t k = 0; k < count + 2; k++) {
        beside[0][k] = beside[1][k] = k == 0 || k == count + 1 ? row->costs->guard : 0;
    }
    t3r_path_link links[T3R_PATH_LINKS] = {0};
    t3r_path_link *along = &links[paths];
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
            links[path].p2 = p2_between(row->costs, here, row->luma_before[column[path]]);
            links[path].to = row->to + path * state + ((size_t)x + 1) * pitch + 1;
        }
        along->from = beside[i & 1];
        along->to = beside[~i & 1] + 1;
        along->from_least = along->least; /* 0 in the beginning */
        along->p2 = p2_between(row->costs, here, row->luma[i == 0 ? x : reverse ? x + 1 : x - 1]);

        row->kernels->path_step(row->cost + (size_t)x * count, links, sums == NULL ? paths : paths + 1, row->costs->p1,
                                count, reverse, sums == NULL ? NULL : sums + (size_t)x * count);
        for (uint32_t path = 0; path < paths; path++) {
            row->to[path * state + leasts + x + 1] = links[path].least;
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
