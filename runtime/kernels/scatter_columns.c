#include "scatter_columns.h"

#include "core/fixed.h"
#include "core/memory.h"

/* What each pixel adds, before it is summed. */
typedef struct pixel_terms {
    uint32_t curvature_q2[T3R_TILE_SIDE][T3R_LANES];
    int32_t gradient_q3[T3R_TILE_SIDE][T3R_LANES];
} pixel_terms;

static inline uint16_t high_of(uint16_t a, uint16_t b)
{
    return (uint16_t)(((uint32_t)a * b) >> 16);
}

/* 4/3 - 4/9 x, x = n / 2^15, is below 1 / x by at most a ninth, d of it; then y (1 + d + d^2), and once more y (1 + d).
 * Less 2 units for what the roundings of x y leave. */
static inline uint16_t reciprocal_of(uint16_t n)
{
    uint16_t y = (uint16_t)(87379 - 65536 - high_of(n, 58254));
    uint16_t d = (uint16_t)(0 - 2 * high_of(n, y));
    y = (uint16_t)(y + high_of(y, (uint16_t)(d + high_of(d, d))));
    d = (uint16_t)(0 - 2 * high_of(n, y));
    return (uint16_t)(y + high_of(y, d) - 2);
}

uint16_t t3r_reciprocal_q31(uint16_t n)
{
    return reciprocal_of(n);
}

/* x times 2^bits where x is below `bound`, and `power` likewise */
static inline uint16_t raise(uint16_t *x, uint16_t power, uint16_t bound, uint16_t bits)
{
    uint16_t by = (uint16_t)(1 + ((uint16_t) - (*x < bound) & ((1 << bits) - 1)));
    *x = (uint16_t)(*x * by);
    return (uint16_t)(power * by);
}

/* The power of two that brings x to 2^15..2^16 - 1; 2^15 for 0. */
static inline uint16_t power_for(uint16_t x)
{
    uint16_t power = raise(&x, 1, 1 << 8, 8);
    power = raise(&x, power, 1 << 12, 4);
    power = raise(&x, power, 1 << 14, 2);
    return raise(&x, power, 1 << 15, 1);
}

uint16_t t3r_mask_weights(const t3r_wanted *want, const uint16_t inside[T3R_LANES], uint32_t column, uint32_t first,
                          uint32_t last, const t3r_blend_weights *weights, t3r_blend_weights *restrict masked)
{
    uint16_t any[T3R_LANES] = {0}, bits = 0;
    for (uint32_t j = first; j <= last; j++) {
        const uint16_t *counts = want->counts[j] + column;
        t3r_blend_weights row = weights[j - first];
        for (int32_t i = 0; i < T3R_LANES; i++) {
            row.q16[i] = (uint16_t)(row.q16[i] & counts[i] & inside[i]);
            any[i] |= row.q16[i];
        }
        masked[j] = row;
    }
    for (int32_t i = 0; i < T3R_LANES; i++) {
        bits |= any[i];
    }
    return bits;
}

/* (a b) / 2^16, round-half-up, in 16-bit steps */
static inline int16_t product_of(int16_t a, int16_t b)
{
    int16_t high = (int16_t)(((int32_t)a * b) >> 16);
    uint16_t low = (uint16_t)((uint32_t)(uint16_t)a * (uint16_t)b);
    return (int16_t)(uint16_t)((uint16_t)high + (low >> 15));
}

/* g = w (c - B), Q6, B = 2 power x rest / (power x left). The rest is at most left / 2 (a weight's colour is, rounded:
 * colours are at most 32,640), and power x left is below 2^16: twice the power times the rest fits, and is 0 when
 * nothing is left. B is below 2^15. */
static inline int16_t change_of(int16_t weight_q15, uint16_t colour_q7, uint16_t rest_q7, uint16_t twice,
                                uint16_t inverse)
{
    uint16_t behind_q7 = high_of((uint16_t)((uint32_t)rest_q7 * twice), inverse);
    return product_of(weight_q15, (int16_t)(colour_q7 - behind_q7));
}

static void terms_of(const t3r_wanted *want, const t3r_tile *tile, const uint16_t colour_q7[3],
                     int16_t weight_q15[T3R_TILE_SIDE][T3R_LANES], uint32_t column, uint32_t first, uint32_t last,
                     pixel_terms *out)
{
    const uint16_t red = colour_q7[0], green = colour_q7[1], blue = colour_q7[2];
    for (uint32_t j = first; j <= last; j++) {
        const uint16_t *after = tile->transmittance_q16[j] + column;
        const uint16_t *r = tile->colour_q7[0][j] + column, *r_drawn = want->drawn.colour_q7[0][j] + column;
        const uint16_t *g = tile->colour_q7[1][j] + column, *g_drawn = want->drawn.colour_q7[1][j] + column;
        const uint16_t *b = tile->colour_q7[2][j] + column, *b_drawn = want->drawn.colour_q7[2][j] + column;
        const int16_t *r_lacks = want->residual_q4[0][j] + column;
        const int16_t *g_lacks = want->residual_q4[1][j] + column;
        const int16_t *b_lacks = want->residual_q4[2][j] + column;
        for (int32_t i = 0; i < T3R_LANES; i++) {
            uint16_t left = after[i];
            int16_t w = weight_q15[j][i];
            uint16_t power = power_for(left), inverse = reciprocal_of((uint16_t)(left * power));
            uint16_t twice = (uint16_t)(2 * power);
            int16_t g0 = change_of(w, red, (uint16_t)(r_drawn[i] - r[i]), twice, inverse);
            int16_t g1 = change_of(w, green, (uint16_t)(g_drawn[i] - g[i]), twice, inverse);
            int16_t g2 = change_of(w, blue, (uint16_t)(b_drawn[i] - b[i]), twice, inverse);
            /* |g| <= 2^14: 3 x 2^28 and 3 x 2^14 x 4080 */
            int32_t squares_q12 = g0 * g0 + g1 * g1 + g2 * g2;
            int32_t products_q10 = g0 * r_lacks[i] + g1 * g_lacks[i] + g2 * b_lacks[i];
            out->curvature_q2[j][i] = ((uint32_t)squares_q12 + 512) >> 10;
            out->gradient_q3[j][i] = (products_q10 + 64) >> 7;
        }
    }
}

static void sum_colours(const t3r_wanted *want, int16_t weight_q15[T3R_TILE_SIDE][T3R_LANES], uint32_t column,
                        uint32_t first, uint32_t last, t3r_scatter_sums *sums)
{
    int32_t weight[T3R_LANES] = {0}, colour[3][T3R_LANES] = {{0}};
    for (uint32_t j = first; j <= last; j++) {
        const int16_t *r_lacks = want->residual_q4[0][j] + column;
        const int16_t *g_lacks = want->residual_q4[1][j] + column;
        const int16_t *b_lacks = want->residual_q4[2][j] + column;
        for (int32_t i = 0; i < T3R_LANES; i++) {
            int16_t w = weight_q15[j][i];
            weight[i] += w;
            colour[0][i] += w * r_lacks[i]; /* 16 x 2^15 x 4080 is below 2^31 */
            colour[1][i] += w * g_lacks[i];
            colour[2][i] += w * b_lacks[i];
        }
    }
    memcpy(sums->weight, weight, sizeof weight);
    memcpy(sums->colour, colour, sizeof colour);
}

/* Sums of sums; the largest of each are the header's bounds times 15,504 (64 bits), 3,876 and 816. */
static void sum_powers(const pixel_terms *from, uint32_t first, uint32_t last, t3r_scatter_sums *sums)
{
    uint32_t curvature[4][T3R_LANES] = {{0}};
    uint64_t curvature_4[T3R_LANES] = {0};
    int32_t gradient[3][T3R_LANES] = {{0}};
    for (uint32_t j = first; j <= last; j++) {
        for (int32_t i = 0; i < T3R_LANES; i++) {
            curvature[0][i] += from->curvature_q2[j][i];
            curvature[1][i] += curvature[0][i];
            curvature[2][i] += curvature[1][i];
            curvature[3][i] += curvature[2][i];
            curvature_4[i] += curvature[3][i];
        }
    }
    for (uint32_t j = first; j <= last; j++) {
        for (int32_t i = 0; i < T3R_LANES; i++) {
            gradient[0][i] += from->gradient_q3[j][i];
            gradient[1][i] += gradient[0][i];
            gradient[2][i] += gradient[1][i];
        }
    }
    memcpy(sums->curvature, curvature, sizeof curvature);
    memcpy(sums->curvature_4, curvature_4, sizeof curvature_4);
    memcpy(sums->gradient, gradient, sizeof gradient);
}

void t3r_scatter_columns(const t3r_wanted *want, const t3r_tile *tile, const uint16_t colour_q7[3], uint32_t column,
                         uint32_t first, uint32_t last, t3r_blend_weights *weights, uint32_t scale,
                         t3r_scatter_sums *sums)
{
    /* in place: signed, and in memory, as compilers then multiply 16 bits */
    int16_t(*weight_q15)[T3R_LANES] = (int16_t(*)[T3R_LANES])(void *)weights;
    const uint16_t factor = (uint16_t)(1u << scale);
    for (uint32_t j = first; j <= last; j++) {
        for (int32_t i = 0; i < T3R_LANES; i++) {
            weight_q15[j][i] = (int16_t)((uint16_t)(weights[j].q16[i] * factor) >> 1);
        }
    }
    pixel_terms out;
    terms_of(want, tile, colour_q7, weight_q15, column, first, last, &out);
    sum_colours(want, weight_q15, column, first, last, sums);
    sum_powers(&out, first, last, sums);
}

/* One row of sums, x^0.. at the places `at`, continued over eight columns: sum k adds up what sum k - 1 has become. */
static inline void continue_sums(int64_t *sums, const uint8_t *at, int order, const int64_t columns[T3R_LANES])
{
    int64_t sum[5];
    for (int k = 0; k <= order; k++) {
        sum[k] = sums[at[k]];
    }
    for (int i = 0; i < T3R_LANES; i++) {
        int64_t more = columns[i];
        for (int k = 0; k <= order; k++) {
            sum[k] += more;
            more = sum[k];
        }
    }
    for (int k = 0; k <= order; k++) {
        sums[at[k]] = sum[k];
    }
}

void t3r_tile_sums_add(t3r_tile_sums *sums, const t3r_scatter_sums *columns)
{
    static const uint8_t at[5][5] = {{T3R_M_1, T3R_M_X, T3R_M_X2, T3R_M_X3, T3R_M_X4},
                                     {T3R_M_Y, T3R_M_XY, T3R_M_X2Y, T3R_M_X3Y},
                                     {T3R_M_Y2, T3R_M_XY2, T3R_M_X2Y2},
                                     {T3R_M_Y3, T3R_M_XY3},
                                     {T3R_M_Y4}};
    int64_t curvature[5][T3R_LANES], gradient[3][T3R_LANES];
    for (int i = 0; i < T3R_LANES; i++) {
        for (int l = 0; l < 4; l++) {
            curvature[l][i] = columns->curvature[l][i];
        }
        curvature[4][i] = (int64_t)columns->curvature_4[i];
        for (int l = 0; l < 3; l++) {
            gradient[l][i] = columns->gradient[l][i];
            sums->colour[l] += columns->colour[l][i];
        }
        sums->weight += columns->weight[i];
    }
    continue_sums(sums->curvature, at[0], 4, curvature[0]);
    continue_sums(sums->curvature, at[1], 3, curvature[1]);
    continue_sums(sums->curvature, at[2], 2, curvature[2]);
    continue_sums(sums->curvature, at[3], 1, curvature[3]);
    continue_sums(sums->curvature, at[4], 0, curvature[4]);
    continue_sums(sums->gradient, at[0], 2, gradient[0]);
    continue_sums(sums->gradient, at[1], 1, gradient[1]);
    continue_sums(sums->gradient, at[2], 0, gradient[2]);
}
