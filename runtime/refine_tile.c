#include "refine_tile.h"

#include <string.h>

#include "exposure.h"
#include "fixed.h"

#define ALONG_MOST_Q8 896       /* |e| <= 3.5: where alpha is not 0, q < 6 and |e| <= sqrt(2 q) < 3.47 */
#define AXIS_MOST_Q20 (2 << 20) /* |K| <= sqrt(t^2 / (t^2 + 0.3)^2) < 0.92 */
#define ORIGIN_MOST_Q20 (1024 << 20)

/* The tile as it will be, and what is missing from it. */
typedef struct wanted {
    t3r_tile drawn;
    int16_t residual_q4[3][T3R_TILE_SIDE][T3R_TILE_SIDE]; /* target - drawn, levels: +-4080 */
    uint8_t counts[T3R_TILE_SIDE][T3R_TILE_SIDE];
} wanted;

/* A splat's own coordinates over eight columns: e = K d, K = T^T S^-1 with the first two columns of T, so that
 * d q = -e . step for a shift by `step` of them. Q20; the first pixel's e and its steps to the right and down. */
typedef struct own_axes {
    int32_t origin[2], right[2], down[2];
} own_axes;

/* What one pixel adds at most, Q7: |g| and |r| are at most 255 sqrt 3 levels, |g| also that times w <= exp(-|e|^2 / 2),
 * and no |e|^k exp(-|e|^2 / 2) with |g| |r|, k <= 2, or |e|^k exp(-|e|^2) with |g|^2, k <= 4, is above 3/4. A block is
 * held to as many times that as it has pixels, so that the bound does not hang on roundings. */
#define MOMENT_MOST_Q7 (195075 * 128)

/* Sums over eight columns of a tile, at most 128 pixels. */
typedef struct block_sums {
    int64_t colour[3], weight;
    int64_t gradient[T3R_REFINE_MOMENTS_2];
    int64_t curvature[T3R_REFINE_MOMENTS_4];
    int32_t pixels;
} block_sums;

static own_axes axes_of(const t3r_refine_view *job, uint32_t index, uint32_t x, uint32_t y)
{
    const t3r_splat *s = &job->splats[index];
    int32_t row[2][3];
    (void)t3r_footprint_rows(job->projection, &job->scene[index], row[0], row[1]);
    int64_t dx = ((int64_t)x << 12) - s->x_q12, dy = ((int64_t)y << 12) - s->y_q12;
    own_axes axes;
    for (int k = 0; k < 2; k++) {
        /* S^-1 is the conic doubled: Q29. |T| <= 2^24: the sums stay below 2^56. */
        int64_t along_x = t3r_round_shift64((int64_t)row[0][k] * s->a_q30 + (int64_t)row[1][k] * s->b_q30, 21);
        int64_t along_y = t3r_round_shift64((int64_t)row[0][k] * s->b_q30 + (int64_t)row[1][k] * s->c_q30, 21);
        axes.right[k] = (int32_t)t3r_clamp64(along_x, -AXIS_MOST_Q20, AXIS_MOST_Q20);
        axes.down[k] = (int32_t)t3r_clamp64(along_y, -AXIS_MOST_Q20, AXIS_MOST_Q20);
        int64_t origin = t3r_round_shift64(axes.right[k] * dx + axes.down[k] * dy, 12);
        axes.origin[k] = (int32_t)t3r_clamp64(origin, -ORIGIN_MOST_Q20, ORIGIN_MOST_Q20);
    }
    return axes;
}

static int32_t halve(int32_t x, uint32_t shift)
{
    return (x + (1 << (shift - 1))) >> shift; /* |x| < 2^31 - 2^(shift - 1), argued where it is called */
}

/* value e^ij. The first value is below 2^24.6, |e| <= 896 and a product of two e at most 784: what comes of it stays
 * below 2^24.6 x 3.5^4 = 2^31.9, and products below 2^40.5. */
static inline int64_t moment(int64_t value_q7, int32_t factor, uint32_t shift)
{
    return t3r_round_shift64(value_q7 * factor, shift);
}

static inline void add_moments_2(int64_t value_q7, const int32_t e_q8[2], const int32_t ee_q6[3], int64_t *sum)
{
    sum[0] += value_q7;
    sum[1] += moment(value_q7, e_q8[0], 8);
    sum[2] += moment(value_q7, e_q8[1], 8);
    sum[3] += moment(value_q7, ee_q6[0], 6);
    sum[4] += moment(value_q7, ee_q6[1], 6);
    sum[5] += moment(value_q7, ee_q6[2], 6);
}

/* i + j = 3 and 4, from the second moments */
static inline void add_moments_4(int64_t value_q7, const int32_t e_q8[2], const int32_t ee_q6[3], int64_t *sum)
{
    int64_t xx = moment(value_q7, ee_q6[0], 6), yy = moment(value_q7, ee_q6[2], 6);
    sum[0] += moment(xx, e_q8[0], 8);
    sum[1] += moment(xx, e_q8[1], 8);
    sum[2] += moment(yy, e_q8[0], 8);
    sum[3] += moment(yy, e_q8[1], 8);
    sum[4] += moment(xx, ee_q6[0], 6);
    sum[5] += moment(xx, ee_q6[1], 6);
    sum[6] += moment(xx, ee_q6[2], 6);
    sum[7] += moment(yy, ee_q6[1], 6);
    sum[8] += moment(yy, ee_q6[2], 6);
}

/* One pixel, to which the splat contributed `weight` of transmittance. What shows behind it is what is still to come,
 * over the transmittance left: g = alpha dC/d alpha = w (c - behind). */
static inline void add_pixel(const wanted *want, const t3r_tile *tile, const t3r_splat *s, uint32_t i, uint32_t j,
                             uint16_t weight_q16, const int32_t e_q8[2], block_sums *sums)
{
    uint32_t left = tile->transmittance_q16[j][i];
    uint32_t inverse = left == 0 ? 0 : UINT32_MAX / left; /* 2^32 / left, a little less */
    int32_t weight_q12 = (weight_q16 + 8) >> 4;
    int32_t gr_q12 = 0; /* three of 65,280 x 4,080 */
    int64_t gg_q16 = 0;
    sums->weight += weight_q12;
    for (int c = 0; c < 3; c++) {
        uint32_t rest_q7 = (uint32_t)(want->drawn.colour_q7[c][j][i] - tile->colour_q7[c][j][i]);
        uint32_t behind_q7 = (uint32_t)(((uint64_t)rest_q7 * inverse) >> 16);
        int32_t change_q7 = (int32_t)s->colour_q7[c] - (int32_t)T3R_MIN(behind_q7, 32640u);
        int32_t g_q8 = (int32_t)t3r_round_shift64((int64_t)weight_q16 * change_q7, 15);
        int32_t r_q4 = want->residual_q4[c][j][i];
        gr_q12 += g_q8 * r_q4;
        gg_q16 += (int64_t)g_q8 * g_q8;
        sums->colour[c] += halve(weight_q12 * r_q4, 8);
    }
    const int32_t ee_q6[3] = {halve(e_q8[0] * e_q8[0], 10), halve(e_q8[0] * e_q8[1], 10), halve(e_q8[1] * e_q8[1], 10)};
    int64_t gg_q7 = t3r_round_shift64(gg_q16, 9);
    add_moments_2(halve(gr_q12, 5), e_q8, ee_q6, sums->gradient);
    add_moments_2(gg_q7, e_q8, ee_q6, sums->curvature);
    add_moments_4(gg_q7, e_q8, ee_q6, sums->curvature + T3R_REFINE_MOMENTS_2);
    sums->pixels++;
}

/* Over `area` pixels a sum is below 2^24.6 area + a half a block, a block holding at least a pixel, and area 2^-shift
 * is at most 64: below 2^31. */
static void add_block(const block_sums *block, t3r_refine_sums *sums)
{
    uint32_t shift = t3r_refine_shift(sums->area);
    int64_t most = (int64_t)MOMENT_MOST_Q7 * block->pixels;
    for (int c = 0; c < 3; c++) {
        sums->colour[c] += (int32_t)t3r_round_shift64(block->colour[c] * 8, shift);
    }
    sums->weight += (int32_t)t3r_round_shift64(block->weight * 8, shift);
    for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
        sums->gradient[k] += (int32_t)t3r_round_shift64(t3r_clamp64(block->gradient[k], -most, most), shift);
    }
    for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
        sums->curvature[k] += (int32_t)t3r_round_shift64(t3r_clamp64(block->curvature[k], -most, most), shift);
    }
}

/* Blends eight columns by the rasterizer's own kernel; what transmittance loses is the weight. */
static void scatter_block(const t3r_refine_view *job, const wanted *want, t3r_tile *tile, uint32_t index, uint32_t left,
                          uint32_t top, uint32_t column, const t3r_tile_blocks *blocks)
{
    const t3r_splat *s = &job->splats[index];
    t3r_lane_splat lane;
    if (!t3r_tile_lane(s, left, top, column, &lane)) {
        return;
    }
    uint32_t slot = index - job->first; /* wraps below the slice */
    if (slot >= job->count) {
        t3r_blend_rows(tile, &lane, column, blocks->first, blocks->last);
        return;
    }
    uint16_t before_q16[T3R_TILE_SIDE][T3R_LANES];
    for (uint32_t j = blocks->first; j <= blocks->last; j++) {
        memcpy(before_q16[j], &tile->transmittance_q16[j][column], sizeof before_q16[j]);
    }
    t3r_blend_rows(tile, &lane, column, blocks->first, blocks->last);

    own_axes axes = axes_of(job, index, left + column, top);
    /* the box's columns alone: beyond it alpha is 0 anyway, and `area` counts the box */
    uint32_t x0 = T3R_MAX(s->x0, left + column) - left, x1 = T3R_MIN(s->x1, left + column + T3R_LANES - 1) - left;
    block_sums sums = {0};
    for (uint32_t j = blocks->first; j <= blocks->last; j++) {
        for (uint32_t i = x0; i <= x1; i++) {
            uint16_t weight_q16 = (uint16_t)(before_q16[j][i - column] - tile->transmittance_q16[j][i]);
            if (weight_q16 == 0 || !want->counts[j][i]) {
                continue;
            }
            int32_t e_q8[2];
            for (int k = 0; k < 2; k++) {
                /* below 2^30 + 23 x 2^21 */
                int32_t e_q20 = axes.origin[k] + (int32_t)(i - column) * axes.right[k] + (int32_t)j * axes.down[k];
                e_q8[k] = t3r_clamp32(halve(e_q20, 12), -ALONG_MOST_Q8, ALONG_MOST_Q8);
            }
            add_pixel(want, tile, s, i, j, weight_q16, e_q8, &sums);
        }
    }
    if (sums.pixels != 0) {
        add_block(&sums, &job->sums[slot]);
    }
}

static void scatter_splat(const t3r_refine_view *job, const wanted *want, t3r_tile *tile, uint32_t index, uint32_t left,
                          uint32_t top)
{
    t3r_tile_blocks blocks = t3r_blocks_of(&job->splats[index], left, top);
    for (uint32_t i = 0; i < blocks.count; i++) {
        scatter_block(job, want, tile, index, left, top, blocks.column + i * T3R_LANES, &blocks);
    }
}

static void blend_splat(t3r_tile *tile, const t3r_splat *s, uint32_t left, uint32_t top)
{
    t3r_tile_blocks blocks = t3r_blocks_of(s, left, top);
    for (uint32_t i = 0; i < blocks.count; i++) {
        uint32_t column = blocks.column + i * T3R_LANES;
        t3r_lane_splat lane;
        if (t3r_tile_lane(s, left, top, column, &lane)) {
            t3r_blend_rows(tile, &lane, column, blocks.first, blocks.last);
        }
    }
}

/* What the drawn tile lacks; columns and rows beyond the image count for nothing. */
static void compare(const t3r_refine_view *job, uint32_t left, uint32_t top, wanted *want)
{
    const t3r_view *view = job->view;
    uint32_t columns = T3R_MIN(view->width - left, (uint32_t)T3R_TILE_SIDE);
    uint32_t rows = T3R_MIN(view->height - top, (uint32_t)T3R_TILE_SIDE);
    memset(want->counts, 0, sizeof want->counts);
    for (uint32_t j = 0; j < rows; j++) {
        size_t row = (size_t)(top + j) * view->width + left;
        for (uint32_t i = 0; i < columns; i++) {
            want->counts[j][i] = view->confidence[row + i] != T3R_CONFIDENCE_NONE;
            for (int c = 0; c < 3; c++) {
                int32_t drawn_q7 = T3R_MIN((int32_t)want->drawn.colour_q7[c][j][i], 32640);
                int32_t residual_q7 = t3r_level_q7(view->colour[c][row + i] * 128u, job->gain_q14[c]) - drawn_q7;
                want->residual_q4[c][j][i] = (int16_t)t3r_round_shift32(residual_q7, 3);
            }
        }
    }
}

void t3r_refine_tile(const t3r_refine_view *job, const uint32_t *list, uint32_t count, uint32_t tile_x, uint32_t tile_y)
{
    uint32_t left = tile_x * T3R_TILE_SIDE, top = tile_y * T3R_TILE_SIDE;
    wanted want;
    t3r_tile_clear(&want.drawn);
    uint32_t used = 0; /* splats before all pixels are done */
    for (; used < count; used++) {
        if (used % T3R_STOP_INTERVAL == T3R_STOP_INTERVAL - 1 && t3r_tile_stopped(&want.drawn)) {
            break;
        }
        blend_splat(&want.drawn, &job->splats[list[used]], left, top);
    }
    compare(job, left, top, &want);

    t3r_tile tile;
    t3r_tile_clear(&tile);
    for (uint32_t i = 0; i < used; i++) {
        scatter_splat(job, &want, &tile, list[i], left, top);
    }
}
