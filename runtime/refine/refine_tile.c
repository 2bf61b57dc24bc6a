#include "refine_tile.h"

#include <stdbool.h>

#include "pointmap/exposure.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "refine_moments.h"

/* What one pixel adds at most, Q7: |g| and |r| are at most 255 sqrt 3 levels, |g| also that times w <= exp(-|e|^2 / 2),
 * and |e|^k exp(-|e|^2 / 2), k <= 2, beside |g| |r| and |e|^k exp(-|e|^2), k <= 4, beside |g|^2 are at most 1. A tile
 * is held to as many times that as the splat's box has pixels there, so that the bound does not hang on roundings. */
#define MOMENT_MOST_Q7 (195075 * 128)

static t3r_own_axes axes_of(const t3r_refine_view *job, uint32_t index)
{
    const t3r_splat *s = &job->splats[index];
    int32_t row[2][3];
    (void)t3r_footprint_rows(job->projection, &job->scene[index], row[0], row[1]);
    t3r_own_axes axes;
    for (int k = 0; k < 2; k++) {
        /* S^-1 is the conic doubled: Q29. |T| <= 2^24: the sums stay below 2^56. */
        int64_t right = t3r_round_shift64((int64_t)row[0][k] * s->a_q30 + (int64_t)row[1][k] * s->b_q30, 21);
        int64_t down = t3r_round_shift64((int64_t)row[0][k] * s->b_q30 + (int64_t)row[1][k] * s->c_q30, 21);
        axes.right_q20[k] = (int32_t)t3r_clamp64(right, -T3R_OWN_AXIS_MOST_Q20, T3R_OWN_AXIS_MOST_Q20);
        axes.down_q20[k] = (int32_t)t3r_clamp64(down, -T3R_OWN_AXIS_MOST_Q20, T3R_OWN_AXIS_MOST_Q20);
    }
    return axes;
}

/* Over `area` pixels a sum is below 2^24.6 area + a half a tile, a tile holding at least a pixel, and area 2^-shift
 * is at most 64: below 2^31. */
static void add_tile(const t3r_tile_sums *tile, const t3r_own_moments *own, uint32_t pixels, t3r_refine_sums *sums)
{
    uint32_t shift = t3r_refine_shift(sums->area), scale = tile->scale;
    int64_t most = t3r_round_shift64((int64_t)MOMENT_MOST_Q7 * pixels, shift);
    for (int c = 0; c < 3; c++) {
        sums->colour[c] += (int32_t)t3r_round_shift64(tile->colour[c], 8 + scale + shift);
    }
    sums->weight += (int32_t)t3r_round_shift64(tile->weight, scale + shift);
    for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
        int64_t sum = t3r_round_shift64(own->gradient[k], scale + shift);
        sums->gradient[k] += (int32_t)t3r_clamp64(sum, -most, most);
    }
    for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
        int64_t sum = t3r_round_shift64(own->curvature[k], 2 * scale + shift);
        sums->curvature[k] += (int32_t)t3r_clamp64(sum, -most, most);
    }
}

/* What the pixels of a splat just blended, with these weights, add to its sums. */
static void scatter(const t3r_refine_view *job, const t3r_wanted *want, const t3r_tile *tile, const t3r_splat *s,
                    const t3r_tile_splat *splat, uint32_t left, uint32_t top, const t3r_blend_weights *weights)
{
    const uint32_t index = (uint32_t)(s - job->splats);
    t3r_refine_sums *to = t3r_refine_sums_in(job->bands, job->band, job->borders, &job->slice, s, index, job->across);
    __builtin_prefetch(to, 1); /* needed last, and seldom near the one before */
    __builtin_prefetch(to->curvature + 8, 1);
    t3r_tile_sums sums;
    if (!job->kernels->scatter(want, tile, splat, weights, &sums)) {
        return;
    }
    uint32_t right = left + splat->column + splat->groups * T3R_LANES - 1u, bottom = top + sums.last;
    uint32_t columns = splat->x1 - splat->x0 + 1u, rows = splat->last - splat->first + 1u;
    t3r_own_axes axes = axes_of(job, index);
    t3r_own_moments own;
    t3r_own_moments_of(&sums, &axes, ((int64_t)right << 12) - s->x_q12, ((int64_t)bottom << 12) - s->y_q12, &own);
    add_tile(&sums, &own, columns * rows, to);
}

/* What the drawn tile lacks; columns and rows beyond the image count for nothing. */
static void compare(const t3r_refine_view *job, uint32_t left, uint32_t top, t3r_wanted *want)
{
    const t3r_view *view = job->view;
    uint32_t columns = T3R_MIN(view->width - left, (uint32_t)T3R_TILE_SIDE);
    uint32_t rows = T3R_MIN(view->height - top, (uint32_t)T3R_TILE_SIDE);
    memset(want->residual_q4, 0, sizeof want->residual_q4);
    memset(want->counts, 0, sizeof want->counts);
    for (uint32_t j = 0; j < rows; j++) {
        size_t row = (size_t)(top + j) * view->width + left;
        for (uint32_t i = 0; i < columns; i++) {
            want->counts[j][i] = t3r_has_depth(view->validity[row + i]) ? UINT16_MAX : 0;
            for (int c = 0; c < 3; c++) {
                int32_t drawn_q7 = T3R_MIN((int32_t)want->drawn.colour_q7[c][j][i], 32640);
                int32_t residual_q7 = t3r_level_q7(view->colour[c][row + i] * 128u, job->gain_q14[c]) - drawn_q7;
                want->residual_q4[c][j][i] = (int16_t)t3r_round_shift32(residual_q7, 3);
            }
        }
    }
}

/* Draws the tile; the weights of as many splats as there is room for are kept. Returns how many are drawn before all
 * pixels are done. */
static uint32_t draw(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t left, uint32_t top,
                     t3r_tile *tile, uint32_t *kept)
{
    t3r_tile_clear(tile);
    uint32_t rows = 0, used = 0;
    bool keeps = true;
    for (*kept = 0; used < count; used++) {
        if (used % T3R_STOP_INTERVAL == T3R_STOP_INTERVAL - 1 && t3r_tile_stopped(tile)) {
            break;
        }
        t3r_tile_splat splat;
        t3r_splat_in_tile(&job->splats[list[used]], left, top, &splat);
        uint32_t more = splat.groups * (splat.last - splat.first + 1u);
        keeps = keeps && more <= job->kept_rows - rows;
        job->kernels->blend(tile, &splat, keeps ? job->kept + rows : NULL);
        rows += keeps ? more : 0;
        *kept += keeps;
    }
    return used;
}

void t3r_refine_tile(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x, uint32_t tile_y)
{
    uint32_t left = tile_x * T3R_TILE_SIDE, top = tile_y * T3R_TILE_SIDE;
    t3r_wanted *want = job->wanted;
    uint32_t kept, used = draw(job, list, count, left, top, &want->drawn, &kept);
    compare(job, left, top, want);

    t3r_tile tile;
    t3r_tile_clear(&tile);
    const t3r_blend_weights *next = job->kept;
    for (uint32_t i = 0; i < used; i++) {
        const t3r_splat *s = &job->splats[list[i]];
        t3r_tile_splat splat;
        t3r_blend_weights again[T3R_TILE_GROUPS * T3R_TILE_SIDE];
        const t3r_blend_weights *weights = i < kept ? next : again;
        if (i < kept) {
            t3r_splat_span(s, left, top, &splat);
            job->kernels->blend_again(&tile, &splat, next);
            next += splat.groups * (splat.last - splat.first + 1u);
        } else {
            t3r_splat_in_tile(s, left, top, &splat);
            job->kernels->blend(&tile, &splat, again);
        }
        /* unsigned: an index below the slice wraps and fails the test */
        if (list[i] - job->slice.first < job->slice.count) {
            scatter(job, want, &tile, s, &splat, left, top, weights);
        }
    }
}

uint64_t t3r_refine_tile_error(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                               uint32_t tile_y, uint32_t *pixels)
{
    uint32_t left = tile_x * T3R_TILE_SIDE, top = tile_y * T3R_TILE_SIDE, kept;
    t3r_wanted *want = job->wanted;
    (void)draw(job, list, count, left, top, &want->drawn, &kept);
    compare(job, left, top, want);
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
