/* Semi-global matching in blocks of rows. */
#include "match.h"

#include "core/fixed.h"
#include "match_clean.h"
#include "match_winner.h"

/* Where things lie in the work. */
typedef struct workspace {
    int16_t *sums;       /* a block's */
    uint8_t *cost;       /* a block's */
    uint8_t *states;     /* one a block: before its first row */
    uint8_t *down[2];    /* the row before, this row */
    uint8_t *up[2];      /* likewise, from below */
    uint8_t *bits;       /* census of a left row */
    uint8_t *bits_right; /* and of a right row, by falling column */
    uint8_t *straight;   /* the same by rising column */
    uint8_t *least;      /* of the cost against each right pixel, by falling column */
    int16_t *winners;
    size_t state_bytes;
} workspace;

static workspace divide(const t3r_match *match)
{
    const size_t width = match->width, count = match->disparities, right = T3R_MATCH_RIGHT(width, count);
    const size_t rows = T3R_MATCH_ROWS(match->height), states = T3R_MATCH_BLOCKS(match->height);
    uint8_t *at = match->work;
    workspace w = {.state_bytes = T3R_MATCH_STATES(match->paths) * T3R_PATH_STATE_BYTES(width, count)};
    w.sums = (int16_t *)(void *)at;
    at += T3R_UP_(width * count * rows * 2);
    w.winners = (int16_t *)(void *)at;
    at += T3R_UP_(right * 4);
    w.cost = at;
    at += T3R_UP_(width * count * rows);
    w.states = at;
    w.down[0] = at + states * w.state_bytes;
    w.down[1] = w.down[0] + w.state_bytes;
    w.up[0] = w.down[1] + w.state_bytes;
    w.up[1] = w.up[0] + w.state_bytes;
    at += T3R_UP_((states + 4) * w.state_bytes);
    w.bits = at;
    at += T3R_UP_(width * T3R_CENSUS_BYTES);
    w.bits_right = at;
    w.straight = at + right * T3R_CENSUS_BYTES;
    w.least = w.straight + right * T3R_CENSUS_BYTES;
    return w;
}

static void census(const uint8_t *luma, uint32_t width, uint32_t height, uint32_t y, uint8_t *bits)
{
    const uint8_t *rows[T3R_CENSUS_ROWS];
    for (int32_t i = 0; i < T3R_CENSUS_ROWS; i++) {
        int32_t row = t3r_clamp32((int32_t)y + i - T3R_CENSUS_ROWS / 2, 0, (int32_t)height - 1);
        rows[i] = luma + (size_t)row * width;
    }
    t3r_census_row(rows, width, width, bits);
}

static void cost_row(const t3r_match *match, const workspace *w, uint32_t y, uint8_t *cost)
{
    const uint32_t width = match->width, count = match->disparities;
    const uint32_t right = (uint32_t)T3R_MATCH_RIGHT(width, count);
    const uint8_t *luma = match->luma[0] + (size_t)y * width, *luma_right = match->luma[1] + (size_t)y * right;
    census(match->luma[0], width, match->height, y, w->bits);
    census(match->luma[1], right, match->height, y, w->straight);
    for (uint32_t i = 0; i < T3R_CENSUS_BYTES; i++) {
        for (uint32_t n = 0; n < right; n++) {
            w->bits_right[i * right + n] = w->straight[i * right + right - 1 - n];
        }
    }
    for (uint32_t n = 0; n < right; n++) {
        w->least[n] = luma_right[right - 1 - n] == 0 ? T3R_CENSUS_NOTHING : 0;
    }
    for (uint32_t x = 0; x < width; x++) {
        uint8_t own[T3R_CENSUS_BYTES], *to = cost + (size_t)x * count;
        for (uint32_t i = 0; i < T3R_CENSUS_BYTES; i++) {
            own[i] = w->bits[i * width + x];
        }
        if (luma[x] != 0) {
            t3r_census_cost(own, w->bits_right + (width - 1 - x), right, w->least + (width - 1 - x), count, to);
        } else {
            for (uint32_t k = 0; k < count; k++) {
                to[k] = 0; /* paths pass through a pixel that says nothing */
            }
        }
    }
}

static void copy(uint8_t *restrict to, const uint8_t *restrict from, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++) {
        to[i] = from[i];
    }
}

static void exchange(uint8_t *pair[2])
{
    uint8_t *first = pair[0];
    pair[0] = pair[1];
    pair[1] = first;
}

void t3r_match_pair(const t3r_match *match)
{
    const uint32_t width = match->width, height = match->height, count = match->disparities;
    const uint32_t rows = T3R_MATCH_ROWS(height), blocks = (uint32_t)T3R_MATCH_BLOCKS(height);
    const bool diagonals = match->paths == 8;
    const t3r_path_costs costs = t3r_path_costs_of(match->same, match->step, match->least_step);
    workspace w = divide(match);
    t3r_path_row row = {.width = width, .disparities = count, .costs = &costs};

    for (uint32_t path = 0; path < T3R_MATCH_STATES(match->paths); path++) {
        for (int i = 0; i < 2; i++) {
            t3r_path_begin(w.down[i] + path * T3R_PATH_STATE_BYTES(width, count), width, count, costs.guard);
            t3r_path_begin(w.up[i] + path * T3R_PATH_STATE_BYTES(width, count), width, count, costs.guard);
        }
    }
    for (uint32_t y = 0; y + rows < height + rows; y++) {
        if (y % rows == 0) {
            copy(w.states + y / rows * w.state_bytes, w.down[0], w.state_bytes);
        }
        if (y / rows + 1 == blocks) {
            break; /* the last block is done from its state */
        }
        cost_row(match, &w, y, w.cost);
        row.luma = match->luma[0] + (size_t)y * width;
        row.luma_before = y > 0 ? row.luma - width : row.luma;
        row.cost = w.cost;
        row.from = w.down[0];
        row.to = w.down[1];
        t3r_path_rows(&row, diagonals);
        exchange(w.down);
    }
    for (uint32_t block = blocks; block-- > 0;) {
        const uint32_t first = block * rows, end = T3R_MIN(first + rows, height);
        copy(w.down[0], w.states + block * w.state_bytes, w.state_bytes);
        for (uint32_t y = first; y < end; y++) {
            const size_t at = (size_t)(y - first) * width * count;
            cost_row(match, &w, y, w.cost + at);
            row.luma = match->luma[0] + (size_t)y * width;
            row.luma_before = y > 0 ? row.luma - width : row.luma;
            row.cost = w.cost + at;
            row.from = w.down[0];
            row.to = w.down[1];
            t3r_path_sums(&row, diagonals, false, w.sums + at);
            exchange(w.down);
        }
        for (uint32_t y = end; y-- > first;) {
            const size_t at = (size_t)(y - first) * width * count;
            row.luma = match->luma[0] + (size_t)y * width;
            row.luma_before = y + 1 < height ? row.luma + width : row.luma;
            row.cost = w.cost + at;
            row.from = w.up[0];
            row.to = w.up[1];
            t3r_path_sums(&row, diagonals, true, w.sums + at);
            exchange(w.up);
            t3r_match_winners(match, y, w.sums + at, w.winners);
        }
    }
}

void t3r_match_all(const t3r_match *match, bool fill)
{
    t3r_match_pair(match);
    t3r_match_agree(match);
    for (uint32_t side = 0; side < 2; side++) {
        (void)t3r_match_speckles(match, side);
        t3r_match_smooth(match, side);
    }
    for (uint32_t side = 0; side < 2 && fill; side++) {
        t3r_match_fill(match, side);
    }
}
