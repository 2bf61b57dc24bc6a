/* SPDX-License-Identifier: Apache-2.0 */
/* Semi-global matching in blocks of rows. */
#include "match.h"

#include "core/fixed.h"
#include "match_clean.h"
#include "match_layout.h"
#include "match_winner.h"
#include "stereo/planes/plane_outline.h"

static void census(const t3r_kernels *kernels, const uint8_t *luma, uint32_t width, uint32_t height, uint32_t y,
                   uint8_t *bits)
{
    const uint8_t *rows[T3R_CENSUS_ROWS];
    for (int32_t i = 0; i < T3R_CENSUS_ROWS; i++) {
        int32_t row = t3r_clamp32((int32_t)y + i - T3R_CENSUS_ROWS / 2, 0, (int32_t)height - 1);
        rows[i] = luma + (size_t)row * width;
    }
    kernels->census_row(rows, width, width, bits);
}

static void copy(uint8_t *restrict to, const uint8_t *restrict from, size_t bytes)
{
    for (size_t i = 0; i < bytes; i++) {
        to[i] = from[i];
    }
}

/* Computes a row's census, or copies it where `kept`: it is computed once and stored in the row's disparities and
 * confidences until these are known. */
static void row_census(const t3r_match *match, uint32_t side, uint32_t width, uint32_t y, bool kept, uint8_t *bits)
{
    uint8_t *first = (uint8_t *)(match->disparity[side] + (size_t)y * width);
    uint8_t *last = match->confidence[side] + (size_t)y * width;
    if (kept) {
        copy(bits, first, 2 * (size_t)width);
        copy(bits + 2 * (size_t)width, last, width);
        return;
    }
    census(match->kernels, match->luma[side], width, match->height, y, bits);
    copy(first, bits, 2 * (size_t)width);
    copy(last, bits + 2 * (size_t)width, width);
}

/* Computes the matching costs of a row. kept: whether this is the row's second time. */
static void cost_row(const t3r_match *match, const t3r_match_layout *w, uint32_t y, bool kept, uint8_t *cost)
{
    const uint32_t width = match->width, right = (uint32_t)T3R_MATCH_RIGHT(width, match->disparities);
    const t3r_census_costs row = {.width = width,
                                  .disparities = match->disparities,
                                  .luma = match->luma[0] + (size_t)y * width,
                                  .luma_right = match->luma[1] + (size_t)y * right,
                                  .bits = w->bits,
                                  .bits_right = w->straight,
                                  .mirrored = w->mirrored,
                                  .least = w->least,
                                  .cost = cost};
    row_census(match, 0, width, y, kept, w->bits);
    row_census(match, 1, right, y, kept, w->straight);
    match->kernels->census_costs(&row);
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
    const t3r_path_costs costs = t3r_path_costs_of(match->p1, match->p2, match->p2_min);
    t3r_cut cut = t3r_cut_of(match->work, T3R_MATCH_PATH_BYTES_(width, height, count, match->paths));
    t3r_match_layout w = t3r_match_lay_out(match, &cut);
    t3r_path_row row = {.width = width, .disparities = count, .diagonals = match->paths == 8, .costs = &costs};

    for (uint32_t path = 0; path < T3R_MATCH_STATES(match->paths); path++) {
        for (int i = 0; i < 2; i++) {
            t3r_path_begin(w.down[i] + path * T3R_PATH_STATE_BYTES(width, count), width, count, costs.guard);
            t3r_path_begin(w.up[i] + path * T3R_PATH_STATE_BYTES(width, count), width, count, costs.guard);
        }
    }
    for (uint32_t y = 0; y < height; y++) {
        if (y % rows == 0) {
            copy(w.states + y / rows * w.state_bytes, w.down[0], w.state_bytes);
        }
        if (y / rows + 1 == blocks) {
            break; /* the last block starts from its stored state */
        }
        cost_row(match, &w, y, false, w.cost);
        row.luma = match->luma[0] + (size_t)y * width;
        row.luma_before = y > 0 ? row.luma - width : row.luma;
        row.cost = w.cost;
        row.from = w.down[0];
        row.to = w.down[1];
        match->kernels->path_row(&row);
        exchange(w.down);
    }
    for (uint32_t block = blocks; block-- > 0;) {
        const uint32_t first = block * rows, end = T3R_MIN(first + rows, height);
        copy(w.down[0], w.states + block * w.state_bytes, w.state_bytes);
        for (uint32_t y = first; y < end; y++) {
            const size_t at = (size_t)(y - first) * width * count;
            cost_row(match, &w, y, block + 1 < blocks, w.cost + at);
            row.luma = match->luma[0] + (size_t)y * width;
            row.luma_before = y > 0 ? row.luma - width : row.luma;
            row.cost = w.cost + at;
            row.from = w.down[0];
            row.to = w.down[1];
            row.sums = w.sums + at;
            row.reverse = false;
            match->kernels->path_row(&row);
            exchange(w.down);
        }
        for (uint32_t y = end; y-- > first;) {
            const size_t at = (size_t)(y - first) * width * count;
            row.luma = match->luma[0] + (size_t)y * width;
            row.luma_before = y + 1 < height ? row.luma + width : row.luma;
            row.cost = w.cost + at;
            row.from = w.up[0];
            row.to = w.up[1];
            row.sums = w.sums + at;
            row.reverse = true;
            match->kernels->path_row(&row);
            exchange(w.up);
            t3r_match_winners(match, y, w.sums + at, w.winners);
        }
    }
}

void t3r_match_all(const t3r_match *match, bool fill)
{
    t3r_match_pair(match);
    t3r_match_agree(match);
    t3r_plane_outline(match);
    for (uint32_t side = 0; side < 2; side++) {
        (void)t3r_match_speckles(match, side);
        t3r_match_smooth(match, side);
    }
    for (uint32_t side = 0; side < 2 && fill; side++) {
        t3r_match_fill(match, side);
    }
}
