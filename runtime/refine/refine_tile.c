#include "refine_tile.h"

#include <stdbool.h>
#include <string.h>

#include "pointmap/exposure.h"
#include "core/fixed.h"
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

/* A splat on its way over a tile. */
typedef struct passage {
    const t3r_splat *splat;
    t3r_tile_blocks blocks;
    uint32_t rows;      /* of each block */
    uint32_t left, top; /* of the tile */
} passage;

/* Weights of both blocks, a row each. */
typedef struct tile_weights {
    t3r_weights rows[T3R_TILE_SIDE / T3R_LANES * T3R_TILE_SIDE];
} tile_weights;

static passage passage_of(const t3r_splat *splat, uint32_t left, uint32_t top)
{
    t3r_tile_blocks blocks = t3r_blocks_of(splat, left, top);
    return (passage){splat, blocks, blocks.last - blocks.first + 1, left, top};
}

static uint32_t column_of(const passage *p, uint32_t block)
{
    return p->blocks.column + block * T3R_LANES;
}

/* Blends by the rasterizer's own kernel; what transmittance loses are the weights, one block's rows after the other's.
 * NULL: not wanted. */
static void blend(const passage *p, t3r_tile *tile, t3r_weights *weights)
{
    const uint32_t first = p->blocks.first, last = p->blocks.last;
    for (uint32_t i = 0; i < p->blocks.count; i++) {
        t3r_weights *block = weights == NULL ? NULL : weights + i * p->rows;
        if (block != NULL) {
            t3r_weights_keep(tile, column_of(p, i), first, last, block);
        }
        t3r_lane_splat lane;
        if (t3r_tile_lane(p->splat, p->left, p->top, column_of(p, i), &lane)) {
            t3r_blend_rows(tile, &lane, column_of(p, i), first, last);
        }
        if (block != NULL) {
            t3r_weights_take(tile, column_of(p, i), first, last, block);
        }
    }
}

static void blend_again(const passage *p, t3r_tile *tile, const t3r_weights *weights)
{
    for (uint32_t i = 0; i < p->blocks.count; i++) {
        t3r_weights_blend(tile, p->splat->colour_q7, column_of(p, i), p->blocks.first, p->blocks.last,
                          weights + i * p->rows);
    }
}

/* The weights of pixels that count, in the splat's box: at rows + 16 block + row; returns all of their bits. Beyond the
 * box alpha is 0 but for roundings, and `area` counts the box. */
static uint32_t mask(const t3r_wanted *want, const passage *p, const t3r_weights *weights, tile_weights *masked)
{
    const uint32_t x0 = T3R_MAX(p->splat->x0, p->left) - p->left, x1 = p->splat->x1 - p->left;
    uint32_t bits = 0;
    for (uint32_t i = 0; i < p->blocks.count; i++) {
        uint16_t inside[T3R_LANES];
        for (uint32_t k = 0; k < T3R_LANES; k++) {
            uint32_t x = column_of(p, i) + k;
            inside[k] = x >= x0 && x <= x1 ? UINT16_MAX : 0;
        }
        bits |= t3r_weights_mask(want, inside, column_of(p, i), p->blocks.first, p->blocks.last, weights + i * p->rows,
                                 masked->rows + i * T3R_TILE_SIDE);
    }
    return bits;
}

static bool is_empty(const tile_weights *masked, uint32_t blocks, uint32_t row)
{
    uint64_t bits = 0;
    for (uint32_t i = 0; i < blocks; i++) {
        uint64_t halves[2];
        memcpy(halves, masked->rows[i * T3R_TILE_SIDE + row].q16, sizeof halves);
        bits |= halves[0] | halves[1];
    }
    return bits == 0;
}

/* What a splat just blended, with these weights, is told. */
static void scatter(const t3r_refine_view *job, const t3r_wanted *want, const t3r_tile *tile, const passage *p,
                    const t3r_weights *weights)
{
    const t3r_splat *s = p->splat;
    const uint32_t index = (uint32_t)(s - job->splats), blocks = p->blocks.count;
    t3r_refine_sums *to = t3r_refine_sums_in(job->bands, job->band, job->borders, &job->slice, s, index, job->across);
    __builtin_prefetch(to, 1); /* needed last, and seldom near the one before */
    __builtin_prefetch(to->curvature + 8, 1);
    tile_weights masked;
    uint32_t bits = mask(want, p, weights, &masked);
    if (bits == 0) {
        return;
    }
    uint32_t first = p->blocks.first, last = p->blocks.last; /* a row between them is not empty */
    while (is_empty(&masked, blocks, first)) {
        first++;
    }
    while (is_empty(&masked, blocks, last)) {
        last--;
    }
    t3r_tile_sums sums;
    memset(&sums, 0, sizeof sums);
    sums.scale = 15 - t3r_msb32(bits);
    for (uint32_t i = 0; i < blocks; i++) {
        t3r_scatter_sums columns;
        t3r_scatter(want, tile, s->colour_q7, column_of(p, i), first, last, masked.rows + i * T3R_TILE_SIDE, sums.scale,
                    &columns);
        t3r_tile_sums_add(&sums, &columns);
    }
    uint32_t right = p->left + column_of(p, blocks) - 1, bottom = p->top + last;
    uint32_t columns = T3R_MIN(s->x1 + 1u, p->left + T3R_TILE_SIDE) - T3R_MAX(s->x0, p->left);
    t3r_own_axes axes = axes_of(job, index);
    t3r_own_moments own;
    t3r_own_moments_of(&sums, &axes, ((int64_t)right << 12) - s->x_q12, ((int64_t)bottom << 12) - s->y_q12, &own);
    add_tile(&sums, &own, columns * p->rows, to);
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
        passage p = passage_of(&job->splats[list[used]], left, top);
        uint32_t more = p.blocks.count * p.rows;
        keeps = keeps && more <= job->kept_rows - rows;
        blend(&p, tile, keeps ? job->kept + rows : NULL);
        rows += keeps ? more : 0;
        *kept += keeps;
    }
    return used;
}

void t3r_refine_tile(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x, uint32_t tile_y)
{
    uint32_t left = tile_x * T3R_TILE_SIDE, top = tile_y * T3R_TILE_SIDE;
    t3r_wanted want;
    uint32_t kept, used = draw(job, list, count, left, top, &want.drawn, &kept);
    compare(job, left, top, &want);

    t3r_tile tile;
    t3r_tile_clear(&tile);
    const t3r_weights *next = job->kept;
    for (uint32_t i = 0; i < used; i++) {
        passage p = passage_of(&job->splats[list[i]], left, top);
        tile_weights again;
        const t3r_weights *weights = i < kept ? next : again.rows;
        if (i < kept) {
            blend_again(&p, &tile, next);
            next += p.blocks.count * p.rows;
        } else {
            blend(&p, &tile, again.rows);
        }
        /* unsigned: an index below the slice wraps and fails the test */
        if (list[i] - job->slice.first < job->slice.count) {
            scatter(job, &want, &tile, &p, weights);
        }
    }
}

uint64_t t3r_refine_tile_error(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x,
                               uint32_t tile_y, uint32_t *pixels)
{
    uint32_t left = tile_x * T3R_TILE_SIDE, top = tile_y * T3R_TILE_SIDE, kept;
    t3r_wanted want;
    (void)draw(job, list, count, left, top, &want.drawn, &kept);
    compare(job, left, top, &want);
    uint64_t error = 0;
    for (uint32_t j = 0; j < T3R_TILE_SIDE; j++) {
        for (uint32_t i = 0; i < T3R_TILE_SIDE; i++) {
            for (int c = 0; c < 3 && want.counts[j][i] != 0; c++) {
                error += (uint32_t)(want.residual_q4[c][j][i] * want.residual_q4[c][j][i]);
            }
            *pixels += want.counts[j][i] != 0;
        }
    }
    return error;
}
