#include "refine_moments.h"

#include "core/fixed.h"

/* Of a tile's 256 pixels, |g|^2 at most 786,432 each (Q2) and |g . r| at most 1,566,720 (Q3), a moment of order n about
 * a pixel of the tile is below 2^27.6 x 15^n and 2^28.6 x 15^n: 2^43.3 for n = 4, 2^36.5 for n = 2. The weights C are
 * at most 15,504 together along an axis, so what is on the way from them to these is below 2^58. */

#define ORIGIN_MOST_Q12 (5 << 12) /* within the ellipse |e| < 3.47, and 0.65 for rounding to a pixel */
#define ORIGIN_FAR_Q12 (32 << 12) /* anywhere in a tile that the ellipse touches */

/* From sums of C(p + k, k), k = 0..n at the places a, b, .., to moments (p - centre)^k, exactly: each of the n rounds
 * turns a factor (p + j) of (p + j) C(p + j - 1, j - 1) = j C(p + j, j) into p - centre, by taking (centre + j) away.
 */
static inline void centre_1(int64_t *m, int a, int b, int64_t centre)
{
    m[b] -= (centre + 1) * m[a];
}

static inline void centre_2(int64_t *m, int a, int b, int c, int64_t centre)
{
    m[c] = 2 * m[c] - (centre + 2) * m[b];
    centre_1(m, a, b, centre);
    centre_1(m, b, c, centre);
}

static inline void centre_3(int64_t *m, int a, int b, int c, int d, int64_t centre)
{
    m[d] = 3 * m[d] - (centre + 3) * m[c];
    m[c] = 2 * m[c] - (centre + 2) * m[b];
    centre_1(m, a, b, centre);
    centre_2(m, b, c, d, centre);
}

static inline void centre_4(int64_t *m, int a, int b, int c, int d, int e, int64_t centre)
{
    m[e] = 4 * m[e] - (centre + 4) * m[d];
    m[d] = 3 * m[d] - (centre + 3) * m[c];
    m[c] = 2 * m[c] - (centre + 2) * m[b];
    centre_1(m, a, b, centre);
    centre_3(m, b, c, d, e, centre);
}

static inline void centre_gradient(int64_t *m, int64_t column, int64_t row)
{
    centre_2(m, T3R_M_1, T3R_M_X, T3R_M_X2, column);
    centre_1(m, T3R_M_Y, T3R_M_XY, column);
    centre_2(m, T3R_M_1, T3R_M_Y, T3R_M_Y2, row);
    centre_1(m, T3R_M_X, T3R_M_XY, row);
}

static inline void centre_curvature(int64_t *m, int64_t column, int64_t row)
{
    centre_4(m, T3R_M_1, T3R_M_X, T3R_M_X2, T3R_M_X3, T3R_M_X4, column);
    centre_3(m, T3R_M_Y, T3R_M_XY, T3R_M_X2Y, T3R_M_X3Y, column);
    centre_2(m, T3R_M_Y2, T3R_M_XY2, T3R_M_X2Y2, column);
    centre_1(m, T3R_M_Y3, T3R_M_XY3, column);
    centre_4(m, T3R_M_1, T3R_M_Y, T3R_M_Y2, T3R_M_Y3, T3R_M_Y4, row);
    centre_3(m, T3R_M_X, T3R_M_XY, T3R_M_XY2, T3R_M_XY3, row);
    centre_2(m, T3R_M_X2, T3R_M_X2Y, T3R_M_X2Y2, row);
    centre_1(m, T3R_M_X3, T3R_M_X3Y, row);
}

/* From moments x^k, k = 0..n at the places a, b, .., to (x + origin)^k: n rounds again, each of them a factor. */
static inline void shift_1(int64_t *m, int a, int b, int64_t origin_q12)
{
    m[b] += t3r_round_shift64(m[a] * origin_q12, 12);
}

static inline void shift_2(int64_t *m, int a, int b, int c, int64_t origin_q12)
{
    shift_1(m, b, c, origin_q12);
    shift_1(m, a, b, origin_q12);
    shift_1(m, b, c, origin_q12);
}

static inline void shift_3(int64_t *m, int a, int b, int c, int d, int64_t origin_q12)
{
    shift_1(m, c, d, origin_q12);
    shift_1(m, b, c, origin_q12);
    shift_1(m, a, b, origin_q12);
    shift_2(m, b, c, d, origin_q12);
}

static inline void shift_4(int64_t *m, int a, int b, int c, int d, int e, int64_t origin_q12)
{
    shift_1(m, d, e, origin_q12);
    shift_1(m, c, d, origin_q12);
    shift_1(m, b, c, origin_q12);
    shift_1(m, a, b, origin_q12);
    shift_3(m, b, c, d, e, origin_q12);
}

static inline void shift_gradient(int64_t *m, const int64_t origin_q12[2])
{
    shift_2(m, T3R_M_1, T3R_M_X, T3R_M_X2, origin_q12[0]);
    shift_1(m, T3R_M_Y, T3R_M_XY, origin_q12[0]);
    shift_2(m, T3R_M_1, T3R_M_Y, T3R_M_Y2, origin_q12[1]);
    shift_1(m, T3R_M_X, T3R_M_XY, origin_q12[1]);
}

static inline void shift_curvature(int64_t *m, const int64_t origin_q12[2])
{
    shift_4(m, T3R_M_1, T3R_M_X, T3R_M_X2, T3R_M_X3, T3R_M_X4, origin_q12[0]);
    shift_3(m, T3R_M_Y, T3R_M_XY, T3R_M_X2Y, T3R_M_X3Y, origin_q12[0]);
    shift_2(m, T3R_M_Y2, T3R_M_XY2, T3R_M_X2Y2, origin_q12[0]);
    shift_1(m, T3R_M_Y3, T3R_M_XY3, origin_q12[0]);
    shift_4(m, T3R_M_1, T3R_M_Y, T3R_M_Y2, T3R_M_Y3, T3R_M_Y4, origin_q12[1]);
    shift_3(m, T3R_M_X, T3R_M_XY, T3R_M_XY2, T3R_M_XY3, origin_q12[1]);
    shift_2(m, T3R_M_X2, T3R_M_X2Y, T3R_M_X2Y2, origin_q12[1]);
    shift_1(m, T3R_M_X3, T3R_M_X3Y, origin_q12[1]);
}

/* The linear part of e = e0 + K (u, v), Q16, and the products of its rows. |a| + |b| <= 1.84 in a row; what multiplies
 * uu, uv and vv is at most 1.84^2 < 2^1.76 together. */
typedef struct linear_map {
    int64_t x[2], y[2];
    int64_t xx[3], xy[3], yy[3];
} linear_map;

/* -K: moments are about the reference pixel, counted from the pixel on. */
static inline linear_map map_of(const t3r_own_axes *axes)
{
    int64_t a = -t3r_round_shift32(axes->right_q20[0], 4), b = -t3r_round_shift32(axes->down_q20[0], 4);
    int64_t c = -t3r_round_shift32(axes->right_q20[1], 4), d = -t3r_round_shift32(axes->down_q20[1], 4);
    return (linear_map){
        .x = {a, b},
        .y = {c, d},
        .xx = {t3r_round_shift64(a * a, 16), t3r_round_shift64(2 * a * b, 16), t3r_round_shift64(b * b, 16)},
        .xy = {t3r_round_shift64(a * c, 16), t3r_round_shift64(a * d + b * c, 16), t3r_round_shift64(b * d, 16)},
        .yy = {t3r_round_shift64(c * c, 16), t3r_round_shift64(2 * c * d, 16), t3r_round_shift64(d * d, 16)},
    };
}

static inline int64_t map_1(const int64_t by[2], const int64_t *m, uint32_t shift)
{
    return t3r_round_shift64(by[0] * m[0] + by[1] * m[1], shift);
}

static inline int64_t map_2(const int64_t by[3], const int64_t *m, uint32_t shift)
{
    return t3r_round_shift64(by[0] * m[0] + by[1] * m[1] + by[2] * m[2], shift);
}

/* To Q7. Below 2^(32.6 + n 4.79) for order n: 2^42.2. */
static inline void map_gradient(const linear_map *by, const int64_t *m, int64_t *own)
{
    own[T3R_M_1] = m[T3R_M_1] * 16;
    own[T3R_M_X] = map_1(by->x, m + T3R_M_X, 12);
    own[T3R_M_Y] = map_1(by->y, m + T3R_M_X, 12);
    own[T3R_M_X2] = map_2(by->xx, m + T3R_M_X2, 12);
    own[T3R_M_XY] = map_2(by->xy, m + T3R_M_X2, 12);
    own[T3R_M_Y2] = map_2(by->yy, m + T3R_M_X2, 12);
}

/* To Q7, below 2^(32.6 + n 4.79): 2^51.8. Order 3 by way of Q4, below 2^39.3 x 2^17.76 / 2^14 = 2^43.1; order 4 by way
 * of Q2, below 2^43.3 x 2^17.76 / 2^16 = 2^45.1, which times 2^17.76 is below 2^62.9. */
static inline void map_curvature(const linear_map *by, const int64_t *m, int64_t *own)
{
    own[T3R_M_1] = m[T3R_M_1] * 32;
    own[T3R_M_X] = map_1(by->x, m + T3R_M_X, 11);
    own[T3R_M_Y] = map_1(by->y, m + T3R_M_X, 11);
    own[T3R_M_X2] = map_2(by->xx, m + T3R_M_X2, 11);
    own[T3R_M_XY] = map_2(by->xy, m + T3R_M_X2, 11);
    own[T3R_M_Y2] = map_2(by->yy, m + T3R_M_X2, 11);
    const int64_t xx_q4[2] = {map_2(by->xx, m + T3R_M_X3, 14), map_2(by->xx, m + T3R_M_X2Y, 14)};
    const int64_t yy_q4[2] = {map_2(by->yy, m + T3R_M_X3, 14), map_2(by->yy, m + T3R_M_X2Y, 14)};
    own[T3R_M_X3] = map_1(by->x, xx_q4, 13);
    own[T3R_M_X2Y] = map_1(by->y, xx_q4, 13);
    own[T3R_M_XY2] = map_1(by->x, yy_q4, 13);
    own[T3R_M_Y3] = map_1(by->y, yy_q4, 13);
    const int64_t xx_q2[3] = {map_2(by->xx, m + T3R_M_X4, 16), map_2(by->xx, m + T3R_M_X3Y, 16),
                              map_2(by->xx, m + T3R_M_X2Y2, 16)};
    const int64_t yy_q2[3] = {map_2(by->yy, m + T3R_M_X4, 16), map_2(by->yy, m + T3R_M_X3Y, 16),
                              map_2(by->yy, m + T3R_M_X2Y2, 16)};
    own[T3R_M_X4] = map_2(by->xx, xx_q2, 11);
    own[T3R_M_X3Y] = map_2(by->xy, xx_q2, 11);
    own[T3R_M_X2Y2] = map_2(by->yy, xx_q2, 11);
    own[T3R_M_XY3] = map_2(by->xy, yy_q2, 11);
    own[T3R_M_Y4] = map_2(by->yy, yy_q2, 11);
}

void t3r_own_moments_of(const t3r_tile_sums *sums, const t3r_own_axes *axes, int64_t dx_q12, int64_t dy_q12,
                        t3r_own_moments *own)
{
    int64_t gradient[T3R_REFINE_MOMENTS_2], curvature[T3R_REFINE_MOMENTS_4];
    for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
        gradient[k] = sums->gradient[k];
    }
    for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
        curvature[k] = sums->curvature[k];
    }
    /* the reference: the pixel next to the mean of |g|^2, which C(p + 1, 1) leaves one too far */
    const int64_t whole = curvature[T3R_M_1], most = whole != 0 ? ORIGIN_MOST_Q12 : ORIGIN_FAR_Q12;
    const int64_t column = whole != 0 ? (2 * curvature[T3R_M_X] - whole) / (2 * whole) : 0;
    const int64_t row = whole != 0 ? (2 * curvature[T3R_M_Y] - whole) / (2 * whole) : 0;
    centre_gradient(gradient, column, row);
    centre_curvature(curvature, column, row);

    const linear_map by = map_of(axes);
    map_gradient(&by, gradient, own->gradient);
    map_curvature(&by, curvature, own->curvature);

    int64_t origin_q12[2];
    dx_q12 -= column * 4096;
    dy_q12 -= row * 4096;
    for (int k = 0; k < 2; k++) {
        int64_t origin = t3r_round_shift64(axes->right_q20[k] * dx_q12 + axes->down_q20[k] * dy_q12, 20);
        origin_q12[k] = t3r_clamp64(origin, -most, most);
    }
    shift_gradient(own->gradient, origin_q12);
    shift_curvature(own->curvature, origin_q12);
}
