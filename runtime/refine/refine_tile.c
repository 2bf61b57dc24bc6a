/* SPDX-License-Identifier: Apache-2.0 */
#include "refine_tile.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "core/gain.h"
#include "core/memory.h"
#include "state/remembered.h"

/* Whether the pixel counts in the loss. */
static bool is_wanted(const t3r_refine_view *job, size_t at)
{
    if (T3R_FEATURE_STREAMS && job->remembered != NULL) {
        return t3r_is_remembered(job->remembered[at]);
    }
    return t3r_has_depth(job->view->validity[at]);
}

/* Computes residuals of `count` pixels of a remembered keyframe, 2^spread apart. */
static void compare_remembered(const uint16_t *pixels, uint32_t spread, int channel, uint16_t gain_q14,
                               const uint16_t *drawn_q7, uint32_t count, int16_t *residual_q4)
{
    for (uint32_t i = 0; i < count; i++) {
        const uint16_t shown_q7 = t3r_level_q7(t3r_remembered_q7(pixels[i << spread], channel), gain_q14);
        residual_q4[i] = (int16_t)t3r_round_shift32(shown_q7 - T3R_MIN((int32_t)drawn_q7[i], 255 * 128), 3);
    }
}

/* Computes the residuals of the drawn tile. Columns and rows beyond the image don't count. */
static void compare(const t3r_refine_view *job, const t3r_tile_place *tile, t3r_wanted *want)
{
    const t3r_view *view = job->view;
    const t3r_lattice lattice = t3r_lattice_in_use(&job->lattice);
    const uint32_t width = t3r_lattice_side(view->width, lattice.x, lattice.spread);
    const uint32_t height = t3r_lattice_side(view->height, lattice.y, lattice.spread);
    const uint32_t columns = T3R_MIN(width - tile->left, (uint32_t)T3R_TILE_SIDE);
    const uint32_t rows = T3R_MIN(height - tile->top, (uint32_t)T3R_TILE_SIDE);
    memset(want->residual_q4, 0, sizeof want->residual_q4);
    memset(want->counts, 0, sizeof want->counts);
    for (uint32_t j = 0; j < rows; j++) {
        const size_t at = (size_t)(((tile->top + j) << lattice.spread) + lattice.y) * view->width +
                          (tile->left << lattice.spread) + lattice.x;
        for (uint32_t i = 0; i < columns; i++) {
            want->counts[j][i] = is_wanted(job, at + ((size_t)i << lattice.spread)) ? UINT16_MAX : 0;
        }
        for (int c = 0; c < 3; c++) {
            const uint16_t *drawn_q7 = want->pixels.colour_q7[c][j];
            int16_t *residual_q4 = want->residual_q4[c][j];
            if (T3R_FEATURE_STREAMS && job->remembered != NULL) {
                compare_remembered(job->remembered + at, lattice.spread, c, job->gain_q14[c], drawn_q7, columns,
                                   residual_q4);
            } else {
                job->kernels->compare_row(view->colour[c] + at, lattice.spread, job->gain_q14[c], drawn_q7, columns,
                                          residual_q4);
            }
        }
    }
}

/* The last splats of the list, from entry `begin` on, that draw something, as they were blended. Each takes one word
 * from the front of the buffer (list entry and weight scale) and its blended rows from the end of the buffer, the first
 * splat's rows last. */
typedef struct kept_splats {
    uint32_t begin, count;
    uint32_t rows; /* rows of all kept splats */
} kept_splats;

#define SCALE_BITS 4 /* leaves 28 bits for the entry; a list has at most 2^24 */
#define ROW_WORDS (uint32_t)(sizeof(t3r_blended_row) / sizeof(uint32_t))

static t3r_blended_row *rows_at(const t3r_refine_view *job, uint32_t rows)
{
    return (t3r_blended_row *)(void *)(job->kept + job->kept_words - rows * ROW_WORDS);
}

/* Draws the list up to `end`, or until all pixels are opaque, and keeps its last splats: a full buffer is emptied and
 * filled again. */
static kept_splats draw(const t3r_refine_view *job, const uint32_t *list, uint32_t end, const t3r_tile_place *place,
                        t3r_tile *tile)
{
    kept_splats kept = {0, 0, 0};
    t3r_tile_clear(tile);
    t3r_tile_splat placed[T3R_STOP_INTERVAL];
    for (uint32_t i = 0; i < end; i++) {
        const uint32_t at = i % T3R_STOP_INTERVAL;
        if (at == 0) {
            job->kernels->place(job->splats, list + i, T3R_MIN(end - i, T3R_STOP_INTERVAL), place, placed);
        }
        if (at == T3R_STOP_INTERVAL - 1 && t3r_tile_is_below(tile, T3R_STOP_Q16)) {
            break;
        }
        const t3r_tile_splat *splat = &placed[at];
        if (splat->drawn == 0) {
            continue;
        }
        const uint32_t more = t3r_rows_of(splat);
        if (kept.count + 1 + (kept.rows + more) * ROW_WORDS > job->kept_words) {
            kept = (kept_splats){i, 0, 0};
        }
        const uint16_t bits = job->kernels->blend_keep(tile, splat, rows_at(job, kept.rows + more));
        if (bits != 0) {
            job->kept[kept.count++] = i << SCALE_BITS | (15 - t3r_msb32(bits));
            kept.rows += more;
        }
    }
    return kept;
}

/* Computes x, y and their steps a pixel, from the axes in Q15 and the offset of the first pixel from the mean in Q12.
 * The results are modulo 2^16, so 32-bit intermediates are enough. */
static void place(const t3r_splat_axes *axes, const t3r_splat *s, uint32_t x, uint32_t y, uint32_t spread,
                  t3r_scatter_splat *out)
{
    const uint32_t dx_q12 = (x << (12 + spread)) - (uint32_t)s->x_q12;
    const uint32_t dy_q12 = (y << (12 + spread)) - (uint32_t)s->y_q12;
    for (int k = 0; k < 2; k++) {
        const uint32_t at_q27 = (uint32_t)axes->right_q15[k] * dx_q12 + (uint32_t)axes->down_q15[k] * dy_q12;
        out->origin_q13[k] = (int16_t)(uint16_t)((at_q27 + (1 << 13)) >> 14);
        out->right_q13[k] = (int16_t)t3r_round_shift32(axes->right_q15[k], 2 - spread);
        out->down_q13[k] = (int16_t)t3r_round_shift32(axes->down_q15[k], 2 - spread);
    }
}

static bool is_in(const t3r_refine_slice *slice, uint32_t index)
{
    return index - slice->first < slice->count; /* unsigned: an index below the slice wraps and fails */
}

/* Prefetch distance of sums, which don't fit the nearest cache and are used in no order. */
#define SUMS_AHEAD 4
static void ask_for_sums(const t3r_refine_slice *slice, uint32_t index)
{
    if (is_in(slice, index)) {
        const t3r_refine_sums *sums = &slice->sums[index - slice->first];
        __builtin_prefetch(sums);
        __builtin_prefetch(sums + 1);
    }
}

/* Leading zeros of weights below 1/64, which a pass over a part of the pixels passes over. */
#define FAINT_SCALE 6

/* Goes through the kept splats from the last down to list entry `first`: accumulates each and removes it from the
 * tile. */
static void take_off(const t3r_refine_view *job, const uint32_t *list, const kept_splats *kept, uint32_t first,
                     const t3r_tile_place *tile)
{
    const uint32_t spread = t3r_lattice_in_use(&job->lattice).spread;
    uint32_t rows = kept->rows;
    for (uint32_t i = kept->count; i-- > 0 && job->kept[i] >> SCALE_BITS >= first;) {
        const uint32_t index = list[job->kept[i] >> SCALE_BITS];
        const t3r_splat *s = &job->splats[index];
        if (i >= SUMS_AHEAD) {
            ask_for_sums(&job->slice, list[job->kept[i - SUMS_AHEAD] >> SCALE_BITS]);
        }
        t3r_tile_splat span;
        t3r_splat_span(s, tile->left, tile->top, &span);
        t3r_scatter_splat splat = {
            .span = &span, .rows = rows_at(job, rows), .scale = job->kept[i] & ((1 << SCALE_BITS) - 1)};
        rows -= t3r_rows_of(&span);
        t3r_refine_sums *sums = NULL;
        const bool faint = spread > 0 && splat.scale >= FAINT_SCALE;
        if (!faint && is_in(&job->slice, index)) {
            sums = t3r_refine_sums_in(job->bands, job->band, job->borders, &job->slice, s, index, job->across);
            place(&sums->axes, s, tile->left + span.column, tile->top + span.first, spread, &splat);
            splat.pixels = (span.x1 - span.x0 + 1u) * (span.last - span.first + 1u);
        }
        job->kernels->scatter(job->wanted, &splat, sums);
    }
}

/* Not inlined: its tile must not be on the stack while splats are removed. */
static __attribute__((noinline)) kept_splats draw_again(const t3r_refine_view *job, const uint32_t *list, uint32_t end,
                                                        const t3r_tile_place *place)
{
    t3r_tile again;
    return draw(job, list, end, place, &again);
}

static t3r_tile_place place_of(const t3r_refine_view *job, uint32_t tile_x, uint32_t tile_y)
{
    return t3r_tile_place_of(tile_x * T3R_TILE_SIDE, tile_y * T3R_TILE_SIDE, t3r_lattice_in_use(&job->lattice).spread);
}

/* Returns the list entry of the first splat in the slice, or `count` when there is none. Earlier entries don't
 * accumulate. */
static uint32_t first_in(const t3r_refine_slice *slice, const uint32_t *list, uint32_t count)
{
    uint32_t first = 0;
    while (first < count && !is_in(slice, list[first])) {
        first++;
    }
    return first;
}

void t3r_refine_tile(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x, uint32_t tile_y)
{
    const t3r_tile_place at = place_of(job, tile_x, tile_y);
    t3r_wanted *want = job->wanted;
    const uint32_t first = first_in(&job->slice, list, count);
    if (first == count) {
        return; /* a slice holds neighbours, so most tiles are drawn for few slices */
    }
    kept_splats kept = draw(job, list, count, &at, &want->pixels);
    compare(job, &at, want);
    if (T3R_FEATURE_LOSS && job->structure != NULL) {
        t3r_structural_loss(want, job->structure);
    }
    memset(want->pixels.colour_q7, 0, sizeof want->pixels.colour_q7); /* after the last splat nothing but black
                                                                       * follows */
    take_off(job, list, &kept, first, &at);
    while (kept.begin > first && job->goes_on(job->context, kept.begin)) {
        kept = draw_again(job, list, kept.begin, &at);
        take_off(job, list, &kept, first, &at);
    }
}

uint64_t t3r_refine_tile_error(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                               uint32_t tile_y, uint32_t *pixels)
{
    const t3r_tile_place at = place_of(job, tile_x, tile_y);
    t3r_wanted *want = job->wanted;
    (void)draw(job, list, count, &at, &want->pixels);
    compare(job, &at, want);
    uint64_t error = 0;
    for (uint32_t j = 0; j < T3R_TILE_SIDE; j++) {
        for (uint32_t i = 0; i < T3R_TILE_SIDE; i++) {
            for (int c = 0; c < 3 && want->counts[j][i] != 0; c++) {
                error += (uint32_t)(want->residual_q4[c][j][i] * want->residual_q4[c][j][i]);
            }
            *pixels += want->counts[j][i] != 0;
        }
    }
    return error;
}

void t3r_refine_tile_levels(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                            uint32_t tile_y, t3r_level_sums *sums)
{
    const t3r_tile_place at = place_of(job, tile_x, tile_y);
    (void)draw(job, list, count, &at, &job->wanted->pixels);
    compare(job, &at, job->wanted);
    t3r_add_levels(job->wanted, &job->structure->levels, sums);
}
