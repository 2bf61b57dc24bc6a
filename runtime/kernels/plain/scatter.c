/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/scatter.h"

#include "core/fixed.h"
#include "kernels/scatter_bits.h"

/* Terms of each pixel of a splat before they are reduced to 16 bits; rows of all groups, the second after the first. */
typedef struct pixel_terms {
    uint32_t square[T3R_BLENDED_ROWS_MOST][T3R_LANES]; /* |g|^2, levels^2 Q(14 + 2 scale), below 3 x 2^30 */
    int32_t product[T3R_BLENDED_ROWS_MOST][T3R_LANES]; /* g . r, levels^2 Q(11 + scale), below 3 x 2^27 */
    uint32_t squares, products;                        /* bitwise or of their sizes */
    uint32_t squares_sum, products_sum; /* sums of their sizes, each without its last 8 bits: below 2^32 */
} pixel_terms;

/* Computes the terms, and replaces the colours behind the splat by those behind the previous one. Weights are scaled
 * so that the largest takes 15 bits. In sums of w r, w has fewer bits by the bits of the pixel count: below 2^31. */
static void terms_of(t3r_wanted *restrict tile, const t3r_scatter_splat *splat, uint32_t less,
                     pixel_terms *restrict terms, int32_t colour[3], int32_t *weight)
{
    const t3r_tile_splat *span = splat->span;
    const int16_t red = (int16_t)span->colour_q7[0], green = (int16_t)span->colour_q7[1];
    const int16_t blue = (int16_t)span->colour_q7[2];
    const uint16_t factor = (uint16_t)(1u << splat->scale);
    const uint32_t rows = span->last - span->first + 1u;
    uint32_t squares[T3R_LANES] = {0}, products[T3R_LANES] = {0};
    uint32_t squares_sum[T3R_LANES] = {0}, products_sum[T3R_LANES] = {0};
    int32_t w_sum[T3R_LANES] = {0}, r_sum[T3R_LANES] = {0}, g_sum[T3R_LANES] = {0}, b_sum[T3R_LANES] = {0};
    for (uint32_t at = 0; at < rows * span->groups; at++) {
        const uint32_t group = at >= rows, j = span->first + at - group * rows;
        const uint32_t column = span->column + group * T3R_LANES;
        const t3r_blended_row *row = &splat->rows[at];
        const uint16_t *counts = tile->counts[j] + column;
        uint16_t *r_behind = tile->pixels.colour_q7[0][j] + column, *g_behind = tile->pixels.colour_q7[1][j] + column;
        uint16_t *b_behind = tile->pixels.colour_q7[2][j] + column;
        const int16_t *r = tile->residual_q4[0][j] + column, *g = tile->residual_q4[1][j] + column;
        const int16_t *b = tile->residual_q4[2][j] + column;
        for (int32_t i = 0; i < T3R_LANES; i++) {
            const int16_t r_step = (int16_t)(red - (int16_t)r_behind[i]);
            const int16_t g_step = (int16_t)(green - (int16_t)g_behind[i]);
            const int16_t b_step = (int16_t)(blue - (int16_t)b_behind[i]);
            const int16_t alpha = row->alpha_q15[i];
            r_behind[i] = (uint16_t)(r_behind[i] + t3r_mulr_q15(alpha, r_step));
            g_behind[i] = (uint16_t)(g_behind[i] + t3r_mulr_q15(alpha, g_step));
            b_behind[i] = (uint16_t)(b_behind[i] + t3r_mulr_q15(alpha, b_step));
            const int16_t w = (int16_t)((uint16_t)((row->weight_q16[i] & counts[i]) * factor) >> 1);
            const int16_t r_moves = t3r_mulr_q15(w, r_step);
            const int16_t g_moves = t3r_mulr_q15(w, g_step);
            const int16_t b_moves = t3r_mulr_q15(w, b_step);
            const uint32_t square = (uint32_t)(r_moves * r_moves + g_moves * g_moves) + (uint32_t)(b_moves * b_moves);
            const int32_t product = r_moves * r[i] + g_moves * g[i] + b_moves * b[i];
            const int16_t share = (int16_t)(w >> less);
            terms->square[at][i] = square;
            terms->product[at][i] = product;
            squares[i] |= square;
            squares_sum[i] += square >> 8;
            const uint32_t size = (uint32_t)(product ^ (product >> 31));
            products[i] |= size;
            products_sum[i] += size >> 8;
            w_sum[i] += share;
            r_sum[i] += share * r[i];
            g_sum[i] += share * g[i];
            b_sum[i] += share * b[i];
        }
    }
    terms->squares = terms->products = terms->squares_sum = terms->products_sum = 0;
    colour[0] = colour[1] = colour[2] = *weight = 0;
    for (int32_t i = 0; i < T3R_LANES; i++) {
        terms->squares |= squares[i];
        terms->products |= products[i];
        terms->squares_sum += squares_sum[i];
        terms->products_sum += products_sum[i];
        *weight += w_sum[i];
        colour[0] += r_sum[i];
        colour[1] += g_sum[i];
        colour[2] += b_sum[i];
    }
}

/* Factors of a group's pixels, row by row. Half a tile's rows at a time, which keeps the stack below its bound. */
#define ROWS_AT_ONCE ((uint32_t)T3R_TILE_SIDE / 2)
typedef int16_t group_plane[ROWS_AT_ONCE][T3R_LANES];
typedef struct factors {
    group_plane x, y, xx, xy, yy;
    group_plane product, square, square_x, square_y, square_xx, square_xy, square_yy;
} factors;

/* Computes the factors of `rows` rows below the first `above` ones of the splat; in `terms` they begin at `at`. */
static void factors_of(const pixel_terms *terms, const t3r_scatter_splat *splat, uint32_t group, uint32_t above,
                       uint32_t at, uint32_t rows, uint32_t square_shift, uint32_t product_shift, factors *restrict f)
{
    const t3r_shift_steps by = t3r_shift_steps_of(square_shift), product_by = t3r_shift_steps_of(product_shift);
    uint16_t x_at[T3R_LANES], y_at[T3R_LANES]; /* modulo 2^16 */
    for (int32_t i = 0; i < T3R_LANES; i++) {
        const int32_t across = i + (int32_t)(group * T3R_LANES);
        x_at[i] = (uint16_t)(splat->origin_q13[0] + across * splat->right_q13[0] + (int32_t)above * splat->down_q13[0]);
        y_at[i] = (uint16_t)(splat->origin_q13[1] + across * splat->right_q13[1] + (int32_t)above * splat->down_q13[1]);
    }
    const uint16_t x_down = (uint16_t)splat->down_q13[0], y_down = (uint16_t)splat->down_q13[1];
    for (uint32_t j = 0; j < rows; j++) {
        const uint32_t *square = terms->square[at + j];
        const int32_t *product = terms->product[at + j];
        for (int32_t i = 0; i < T3R_LANES; i++) {
            const int16_t x = (int16_t)x_at[i], y = (int16_t)y_at[i];
            const int16_t xx = t3r_mulr_q15(x, x), xy = t3r_mulr_q15(x, y), yy = t3r_mulr_q15(y, y);
            const int16_t m = (int16_t)(((square[i] >> by.first) + by.half) >> by.half);
            f->x[j][i] = x;
            f->y[j][i] = y;
            f->xx[j][i] = xx;
            f->xy[j][i] = xy;
            f->yy[j][i] = yy;
            f->square[j][i] = m;
            f->product[j][i] =
                (int16_t)(((product[i] >> product_by.first) + (int32_t)product_by.half) >> product_by.half);
            f->square_x[j][i] = t3r_mulr_q15(m, x);
            f->square_y[j][i] = t3r_mulr_q15(m, y);
            f->square_xx[j][i] = t3r_mulr_q15(m, xx);
            f->square_xy[j][i] = t3r_mulr_q15(m, xy);
            f->square_yy[j][i] = t3r_mulr_q15(m, yy);
            x_at[i] = (uint16_t)(x_at[i] + x_down);
            y_at[i] = (uint16_t)(y_at[i] + y_down);
        }
    }
}

/* Returns the dot product over whole rows, modulo 2^32. */
static uint32_t dot(const group_plane plane, const group_plane other, uint32_t rows)
{
    const int16_t *a = plane[0], *b = other[0];
    uint32_t sum = 0;
    for (uint32_t i = 0; i < T3R_LANES * rows; i++) {
        sum += (uint32_t)(a[i] * b[i]);
    }
    return sum;
}

static uint32_t sum_of(const group_plane plane, uint32_t rows)
{
    const int16_t *a = plane[0];
    int32_t sum = 0;
    for (uint32_t i = 0; i < T3R_LANES * rows; i++) {
        sum += a[i];
    }
    return (uint32_t)sum;
}

static void add_group(const factors *f, uint32_t rows, uint32_t gradient[T3R_REFINE_MOMENTS_2],
                      uint32_t curvature[T3R_REFINE_MOMENTS_4])
{
    const group_plane *const powers[] = {&f->x, &f->y, &f->xx, &f->xy, &f->yy};
    gradient[0] += sum_of(f->product, rows);
    curvature[0] += sum_of(f->square, rows);
    for (int k = 0; k < 5; k++) {
        gradient[1 + k] += dot(f->product, *powers[k], rows);
        curvature[1 + k] += dot(f->square, *powers[k], rows);
    }
    curvature[T3R_M_X3] += dot(f->square_x, f->xx, rows);
    curvature[T3R_M_X2Y] += dot(f->square_x, f->xy, rows);
    curvature[T3R_M_XY2] += dot(f->square_x, f->yy, rows);
    curvature[T3R_M_Y3] += dot(f->square_y, f->yy, rows);
    curvature[T3R_M_X4] += dot(f->square_xx, f->xx, rows);
    curvature[T3R_M_X3Y] += dot(f->square_xx, f->xy, rows);
    curvature[T3R_M_X2Y2] += dot(f->square_xx, f->yy, rows);
    curvature[T3R_M_XY3] += dot(f->square_xy, f->yy, rows);
    curvature[T3R_M_Y4] += dot(f->square_yy, f->yy, rows);
}

void t3r_scatter_c(t3r_wanted *restrict tile, const t3r_scatter_splat *splat, t3r_refine_sums *restrict sums)
{
    const t3r_tile_splat *span = splat->span;
    const uint32_t rows = span->last - span->first + 1u, all_rows = t3r_rows_of(span), less = t3r_count_bits(all_rows);
    pixel_terms terms;
    int32_t colour[3], weight;
    terms_of(tile, splat, less, &terms, colour, &weight);
    if (sums == NULL) {
        return;
    }
    const uint32_t square_shift = t3r_term_shift(terms.squares, terms.squares_sum, all_rows);
    const uint32_t product_shift = t3r_term_shift(terms.products, terms.products_sum, all_rows);
    uint32_t gradient[T3R_REFINE_MOMENTS_2] = {0}, curvature[T3R_REFINE_MOMENTS_4] = {0};
    for (uint32_t group = 0; group < span->groups; group++) {
        for (uint32_t above = 0; above < rows; above += ROWS_AT_ONCE) {
            const uint32_t some = T3R_MIN(rows - above, ROWS_AT_ONCE);
            factors f;
            factors_of(&terms, splat, group, above, group * rows + above, some, square_shift, product_shift, &f);
            add_group(&f, some, gradient, curvature);
        }
    }

    const t3r_sum_shifts by = t3r_sum_shifts_of(sums->area, splat->scale, less, square_shift, product_shift);
    t3r_add_scattered(colour, weight, gradient, curvature, &by, t3r_moment_most(sums->area, splat->pixels), sums);
}
