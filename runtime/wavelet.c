/* Integer lifting wavelets, and the texture energy that they measure.
 *
 * One level of db2 on a row or column of samples e[0] o[0] e[1] o[1] ...:
 *     d1[n] = o[n] - sqrt(3) e[n]
 *     s[n]  = e[n] + sqrt(3)/4 d1[n] - (2 - sqrt 3)/4 d1[n + 1]     the low half
 *     d[n]  = d1[n] + s[n - 1]                                     the high half
 * which is db2 without its last scaling: orthonormal = 1.93185 s and 0.51764 d ((sqrt 3 +- 1) / sqrt 2). Beyond
 * the ends the nearest d1 and s are repeated; an odd length leaves its last even sample without a partner:
 * s[last] = e[last] - (2 - sqrt 3) e[last - 1], which keeps the low half's gain for constants, sqrt 3 - 1.
 *
 * Why 16 bits suffice. Input: |x| <= 2048. A coefficient is a linear function of the input, so for any image its
 * size is at most 2048 times the product, over the two directions, of the sum of absolute weights in one
 * direction. The largest such sums over all lengths, low and high half:
 *     level    db2 low   db2 high   5/3 low   5/3 high   Haar low   Haar high
 *       1       1.268     3.233      1.500     2.000        1          2
 *       2       1.500     2.824      1.625     2.500        1          2
 *       3       1.661     2.733      1.688     2.750        1          2
 *       4       1.772     2.733      1.698     2.805        1          2
 *       5       1.851     2.796      1.707     2.827        1          2
 * The largest coefficient is db2's first D: 3.233^2 x 2048 = 21,400. Within a step the largest term is o - 2 e and
 * e + e_next: over the high half of the other direction at most 3.233 x (1 + 2) x 2048 = 19,900. Each of a level's
 * six steps rounds by at most 1 (two roundings of a half), and such errors grow by the same sums: below 200 in
 * all after five levels. Everything stays below 2^15 (tests/unit/test_wavelet.c recomputes the table and drives
 * every kind with the images that attain it).
 *
 * Texture: on level 1 |h| + |v| is at most 2 x 8,393 and 0.268 |d| 5,733: below 2^15. On the others |h| and |v|
 * are at most 10,600 and |d| 16,400. */
#include "wavelet.h"

#include <stdbool.h>
#include <string.h>

#include "fixed.h"
#include "kernels/wavelet_rows.h"

#define PAD 8u /* room for a repeated neighbour, kept at 16 bytes so that rows stay aligned */

/* A split row, with one sample of room before and behind each half. */
typedef struct halves {
    int16_t *even, *odd;
    uint32_t evens, odds;
} halves;

static halves halves_in(int16_t *work, uint32_t length)
{
    halves x;
    x.evens = (length + 1) / 2;
    x.odds = length / 2;
    x.even = work + PAD;
    x.odd = x.even + (x.evens + PAD - 1) / PAD * PAD + 2 * PAD;
    return x;
}

/* Two halves of at most width / 2 + 1 + 7 samples and 5 pads; or a row to swap, a bit for each row (in words of
 * 16); or the texture rows of all levels. */
static size_t work_samples(uint32_t width, uint32_t height)
{
    return (size_t)width + 2 * T3R_MAX_LEVELS + height / 16 + 1 + 7 * PAD;
}

size_t t3r_wavelet_work_bytes(uint32_t width, uint32_t height)
{
    return work_samples(width, height) * sizeof(int16_t);
}

/* ---- one row ---------------------------------------------------------------------------------------- */

static void row_forward_db2(halves x, bool periodic)
{
    t3r_row_db2_predict(x.odd, x.even, x.odds);
    x.odd[x.odds] = periodic ? x.odd[0] : x.odd[x.odds - 1];
    if (x.evens > x.odds) {
        t3r_row_db2_tail(x.even + x.odds, x.even + x.odds - 1, 1);
    }
    t3r_row_db2_update(x.even, x.odd, x.odd + 1, x.odds);
    x.even[-1] = periodic ? x.even[x.odds - 1] : x.even[0];
    t3r_row_add(x.odd, x.even - 1, x.odds);
}

static void row_inverse_db2(halves x, bool periodic)
{
    x.even[-1] = periodic ? x.even[x.odds - 1] : x.even[0];
    t3r_row_subtract(x.odd, x.even - 1, x.odds);
    x.odd[x.odds] = periodic ? x.odd[0] : x.odd[x.odds - 1];
    t3r_row_db2_unupdate(x.even, x.odd, x.odd + 1, x.odds);
    if (x.evens > x.odds) {
        t3r_row_db2_untail(x.even + x.odds, x.even + x.odds - 1, 1);
    }
    t3r_row_db2_unpredict(x.odd, x.even, x.odds);
}

/* The odd samples on both sides of each even one, for 5/3's update. */
static void repeat_odds(halves x, bool periodic)
{
    x.odd[-1] = periodic ? x.odd[x.odds - 1] : x.odd[0];
    x.odd[x.odds] = x.odd[x.odds - 1];
}

/* The even sample behind the last odd one, for 5/3's prediction. */
static void repeat_even(halves x, bool periodic)
{
    if (x.evens == x.odds) {
        x.even[x.odds] = periodic ? x.even[0] : x.even[x.odds - 1];
    }
}

static void row_forward(int16_t *row, uint32_t width, t3r_wavelet kind, bool periodic, int16_t *work)
{
    halves x = halves_in(work, width);

    if (width < 2) {
        return;
    }
    t3r_row_split(x.even, x.odd, row, width);
    switch (kind) {
    case T3R_WAVELET_HAAR:
        t3r_row_subtract(x.odd, x.even, x.odds);
        t3r_row_haar_update(x.even, x.odd, x.odds);
        break;
    case T3R_WAVELET_CDF53:
        repeat_even(x, periodic);
        t3r_row_cdf53_predict(x.odd, x.even, x.even + 1, x.odds);
        repeat_odds(x, periodic);
        t3r_row_cdf53_update(x.even, x.odd - 1, x.odd, x.evens);
        break;
    default:
        row_forward_db2(x, periodic);
        break;
    }
    memcpy(row, x.even, x.evens * sizeof(int16_t));
    memcpy(row + x.evens, x.odd, x.odds * sizeof(int16_t));
}

static void row_inverse(int16_t *row, uint32_t width, t3r_wavelet kind, bool periodic, int16_t *work)
{
    halves x = halves_in(work, width);

    if (width < 2) {
        return;
    }
    memcpy(x.even, row, x.evens * sizeof(int16_t));
    memcpy(x.odd, row + x.evens, x.odds * sizeof(int16_t));
    switch (kind) {
    case T3R_WAVELET_HAAR:
        t3r_row_haar_unupdate(x.even, x.odd, x.odds);
        t3r_row_add(x.odd, x.even, x.odds);
        break;
    case T3R_WAVELET_CDF53:
        repeat_odds(x, periodic);
        t3r_row_cdf53_unupdate(x.even, x.odd - 1, x.odd, x.evens);
        repeat_even(x, periodic);
        t3r_row_cdf53_unpredict(x.odd, x.even, x.even + 1, x.odds);
        break;
    default:
        row_inverse_db2(x, periodic);
        break;
    }
    t3r_row_join(row, x.even, x.odd, width);
}

/* ---- one level, rows staying where they are: row 2 n becomes low, row 2 n + 1 high --------------------- */

/* A level's rows. Lifting runs down the rows and touches each while it is in cache; rows are made just ahead. */
typedef struct level {
    int16_t *plane;
    size_t stride;            /* samples from row to row */
    uint32_t width, height;
    t3r_wavelet kind;
    bool periodic;
    int16_t *work;
    const uint8_t *const *colour; /* the image whose luma fills the plane; NULL: it is filled */
    uint32_t ready;           /* rows [0, ready) are horizontally transformed */
} level;

static int16_t *even_row(const level *x, uint32_t n)
{
    return x->plane + (size_t)2 * n * x->stride;
}

static int16_t *odd_row(const level *x, uint32_t n)
{
    return even_row(x, n) + x->stride;
}

static void make_rows(level *x, uint32_t end)
{
    for (; x->ready < T3R_MIN(end, x->height); x->ready++) {
        int16_t *row = x->plane + (size_t)x->ready * x->stride;
        if (x->colour != NULL) {
            size_t at = (size_t)x->ready * x->width;
            t3r_row_luma(row, x->colour[0] + at, x->colour[1] + at, x->colour[2] + at, x->width);
        }
        row_forward(row, x->width, x->kind, x->periodic, x->work);
    }
}

static void columns_forward_db2(level *x)
{
    uint32_t pairs = x->height / 2;
    bool tail = x->height % 2 != 0;

    /* n runs one behind the prediction, because the update of n needs the prediction of n + 1 */
    make_rows(x, 2);
    t3r_row_db2_predict(odd_row(x, 0), even_row(x, 0), x->width);
    for (uint32_t n = 0; n < pairs; n++) {
        const int16_t *next = x->periodic ? odd_row(x, 0) : odd_row(x, n);
        make_rows(x, 2 * n + 4);
        if (n + 1 < pairs) {
            t3r_row_db2_predict(odd_row(x, n + 1), even_row(x, n + 1), x->width);
            next = odd_row(x, n + 1);
        } else if (tail) {
            t3r_row_db2_tail(even_row(x, n + 1), even_row(x, n), x->width);
        }
        t3r_row_db2_update(even_row(x, n), odd_row(x, n), next, x->width);
        if (n > 0) {
            t3r_row_add(odd_row(x, n), even_row(x, n - 1), x->width);
        } else if (!x->periodic) {
            t3r_row_add(odd_row(x, 0), even_row(x, 0), x->width);
        }
    }
    if (x->periodic) {
        t3r_row_add(odd_row(x, 0), even_row(x, pairs - 1), x->width);
    }
}

static void columns_inverse_db2(level *x)
{
    uint32_t pairs = x->height / 2;

    t3r_row_subtract(odd_row(x, 0), even_row(x, x->periodic ? pairs - 1 : 0), x->width);
    for (uint32_t n = 0; n < pairs; n++) {
        const int16_t *next = x->periodic ? odd_row(x, 0) : odd_row(x, n);
        if (n + 1 < pairs) {
            t3r_row_subtract(odd_row(x, n + 1), even_row(x, n), x->width);
            next = odd_row(x, n + 1);
        }
        t3r_row_db2_unupdate(even_row(x, n), odd_row(x, n), next, x->width);
        /* a periodic border's last update still reads the first odd row as it is */
        if (n > 0 || !x->periodic) {
            t3r_row_db2_unpredict(odd_row(x, n), even_row(x, n), x->width);
        }
    }
    if (x->periodic) {
        t3r_row_db2_unpredict(odd_row(x, 0), even_row(x, 0), x->width);
    }
    if (x->height % 2 != 0) {
        t3r_row_db2_untail(even_row(x, pairs), even_row(x, pairs - 1), x->width);
    }
}

static void columns_forward_haar(level *x)
{
    for (uint32_t n = 0; n < x->height / 2; n++) {
        make_rows(x, 2 * n + 2);
        t3r_row_subtract(odd_row(x, n), even_row(x, n), x->width);
        t3r_row_haar_update(even_row(x, n), odd_row(x, n), x->width);
    }
    make_rows(x, x->height);
}

static void columns_inverse_haar(level *x)
{
    for (uint32_t n = 0; n < x->height / 2; n++) {
        t3r_row_haar_unupdate(even_row(x, n), odd_row(x, n), x->width);
        t3r_row_add(odd_row(x, n), even_row(x, n), x->width);
    }
}

/* The even row behind odd row n. */
static const int16_t *even_behind(const level *x, uint32_t n)
{
    if (2 * n + 2 < x->height) {
        return even_row(x, n + 1);
    }
    return even_row(x, x->periodic ? 0 : n);
}

static void columns_forward_cdf53(level *x)
{
    uint32_t pairs = x->height / 2;

    for (uint32_t n = 0; n < pairs; n++) {
        make_rows(x, 2 * n + 3);
        t3r_row_cdf53_predict(odd_row(x, n), even_row(x, n), even_behind(x, n), x->width);
        if (n > 0) {
            t3r_row_cdf53_update(even_row(x, n), odd_row(x, n - 1), odd_row(x, n), x->width);
        } else if (!x->periodic) {
            t3r_row_cdf53_update(even_row(x, 0), odd_row(x, 0), odd_row(x, 0), x->width);
        }
    }
    if (x->periodic) {
        t3r_row_cdf53_update(even_row(x, 0), odd_row(x, pairs - 1), odd_row(x, 0), x->width);
    }
    if (x->height % 2 != 0) {
        t3r_row_cdf53_update(even_row(x, pairs), odd_row(x, pairs - 1), odd_row(x, pairs - 1), x->width);
    }
}

static void columns_inverse_cdf53(level *x)
{
    uint32_t pairs = x->height / 2;

    t3r_row_cdf53_unupdate(even_row(x, 0), odd_row(x, x->periodic ? pairs - 1 : 0), odd_row(x, 0), x->width);
    for (uint32_t n = 0; n < pairs; n++) {
        if (n + 1 < pairs) {
            t3r_row_cdf53_unupdate(even_row(x, n + 1), odd_row(x, n), odd_row(x, n + 1), x->width);
        } else if (x->height % 2 != 0) {
            t3r_row_cdf53_unupdate(even_row(x, n + 1), odd_row(x, n), odd_row(x, n), x->width);
        }
        t3r_row_cdf53_unpredict(odd_row(x, n), even_row(x, n), even_behind(x, n), x->width);
    }
}

static void level_forward(level *x)
{
    x->ready = 0;
    if (x->height < 2) {
        make_rows(x, x->height);
        return;
    }
    switch (x->kind) {
    case T3R_WAVELET_HAAR:
        columns_forward_haar(x);
        break;
    case T3R_WAVELET_CDF53:
        columns_forward_cdf53(x);
        break;
    default:
        columns_forward_db2(x);
        break;
    }
}

static void level_inverse(level *x)
{
    if (x->height >= 2) {
        switch (x->kind) {
        case T3R_WAVELET_HAAR:
            columns_inverse_haar(x);
            break;
        case T3R_WAVELET_CDF53:
            columns_inverse_cdf53(x);
            break;
        default:
            columns_inverse_db2(x);
            break;
        }
    }
    for (uint32_t y = 0; y < x->height; y++) {
        row_inverse(x->plane + (size_t)y * x->stride, x->width, x->kind, x->periodic, x->work);
    }
}

/* ---- Mallat's layout --------------------------------------------------------------------------------- */

/* Brings low rows to the top and high rows below them, or back, following each cycle of the permutation once. */
static void order_rows(const level *x, bool back)
{
    size_t bytes = x->width * sizeof(int16_t);
    int16_t *held = x->work;
    uint16_t *moved = (uint16_t *)(x->work + x->width);
    uint32_t lows = (x->height + 1) / 2;

    memset(moved, 0, (x->height / 16 + 1) * sizeof(uint16_t));
    for (uint32_t first = 0; first < x->height; first++) {
        if ((moved[first / 16] >> first % 16 & 1) != 0) {
            continue;
        }
        memcpy(held, x->plane + first * x->stride, bytes);
        uint32_t to = first;
        /* at most height turns over all cycles */
        for (;;) {
            uint32_t from = back ? to / 2 + (to % 2 != 0 ? lows : 0) : to < lows ? 2 * to : 2 * (to - lows) + 1;
            moved[to / 16] = (uint16_t)(moved[to / 16] | 1u << to % 16);
            if (from == first) {
                break;
            }
            memcpy(x->plane + to * x->stride, x->plane + from * x->stride, bytes);
            to = from;
        }
        memcpy(x->plane + to * x->stride, held, bytes);
    }
}

/* Length of one side after `levels` halvings that keep the odd sample. */
static uint32_t halved(uint32_t side, uint32_t levels)
{
    return (side + (1u << levels) - 1) >> levels;
}

void t3r_wavelet_forward_border(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                                t3r_wavelet_border border, int16_t *work)
{
    for (uint32_t l = 0; l < levels; l++) {
        level x = {plane, width, halved(width, l), halved(height, l), kind, border == T3R_WAVELET_PERIODIC, work,
                   NULL, 0};
        level_forward(&x);
        order_rows(&x, false);
    }
}

void t3r_wavelet_inverse_border(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                                t3r_wavelet_border border, int16_t *work)
{
    for (uint32_t l = levels; l-- > 0;) {
        level x = {plane, width, halved(width, l), halved(height, l), kind, border == T3R_WAVELET_PERIODIC, work,
                   NULL, 0};
        order_rows(&x, true);
        level_inverse(&x);
    }
}

void t3r_wavelet_forward(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                         int16_t *work)
{
    t3r_wavelet_forward_border(plane, width, height, levels, kind, T3R_WAVELET_SYMMETRIC, work);
}

void t3r_wavelet_inverse(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                         int16_t *work)
{
    t3r_wavelet_inverse_border(plane, width, height, levels, kind, T3R_WAVELET_SYMMETRIC, work);
}

/* ---- texture ------------------------------------------------------------------------------------------ */

/* Orthonormal over lifted. db2: low 1.93185, high 0.51764, so h and v 1, d 2 - sqrt 3, and 2 + sqrt 3 a level
 * more. Haar, and 5/3 on the same footing: low sqrt 2, high 1 / sqrt 2, so 1, 1/2, and 2 a level more. */
static const uint16_t finest_d_gain_q16[T3R_WAVELET_COUNT] = {17560, 32768, 32768};
static const uint16_t gain_q8[T3R_WAVELET_COUNT][T3R_MAX_LEVELS] = {
    {256, 955, 3566, 13307, 49662}, {256, 512, 1024, 2048, 4096}, {256, 512, 1024, 2048, 4096}};

/* The texture of row n of level `l` (from 1) of a transform whose rows stayed in place; missing coefficients at
 * odd sides count nothing. */
static void texture_row(const int16_t *plane, uint32_t width, uint32_t height, uint32_t l, uint32_t n,
                        t3r_wavelet kind, uint16_t *out)
{
    uint32_t across = halved(width, l - 1);
    uint32_t lows = (across + 1) / 2, highs = across / 2;
    size_t stride = (size_t)width << (l - 1);
    const int16_t *upper = plane + (size_t)2 * n * stride;
    bool paired = 2 * n + 1 < halved(height, l - 1);
    const int16_t *lower = paired ? upper + stride : upper;
    uint32_t gain = gain_q8[kind][l - 1];
    uint32_t d_gain = l > 1 ? gain_q8[kind][l - 2] : 0;

    if (!paired) {
        /* an odd height's last row has no partner: |h| alone */
        for (uint32_t i = 0; i < lows; i++) {
            uint32_t h = i < highs ? (uint32_t)t3r_abs32(upper[lows + i]) : 0;
            out[i] = (uint16_t)T3R_MIN((gain * h + 128) >> 8, 65535u);
        }
        return;
    }
    if (l == 1) {
        t3r_row_texture_finest(out, upper + lows, lower, lower + lows, finest_d_gain_q16[kind], highs);
    } else {
        t3r_row_texture_coarse(out, upper + lows, lower, lower + lows, gain, d_gain, highs);
    }
    if (lows > highs) {
        uint32_t v = (uint32_t)t3r_abs32(lower[highs]);
        out[highs] = (uint16_t)T3R_MIN((gain * v + 128) >> 8, 65535u);
    }
}

/* Rows of all levels down the image: a level's row is made when the image reaches it and holds the sum of itself
 * and the coarser ones. */
static void texture_plane(const int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                          uint16_t *texture_q4, uint16_t *work)
{
    uint16_t *rows[T3R_MAX_LEVELS + 1];
    uint16_t *free_row = work;

    for (uint32_t l = 1; l <= levels; l++) {
        rows[l] = free_row;
        free_row += halved(width, l);
    }
    for (uint32_t y = 0; y < height; y += 2) {
        for (uint32_t l = levels; l >= 1; l--) {
            if ((y & ((1u << l) - 1)) != 0) {
                continue;
            }
            texture_row(plane, width, height, l, y >> l, kind, rows[l]);
            if (l < levels) {
                t3r_row_texture_add(rows[l], rows[l + 1], halved(width, l));
            }
        }
        uint16_t *out = texture_q4 + (size_t)y * width;
        t3r_row_texture_spread(out, rows[1], width);
        if (y + 1 < height) {
            memcpy(out + width, out, width * sizeof(uint16_t));
        }
    }
}

void t3r_wavelet_texture_border(const uint8_t *const colour[3], uint32_t width, uint32_t height, uint32_t levels,
                                t3r_wavelet kind, t3r_wavelet_border border, uint16_t *texture_q4, int16_t *plane,
                                int16_t *work)
{
    if (levels == 0) {
        memset(texture_q4, 0, (size_t)width * height * sizeof(uint16_t));
        return;
    }
    for (uint32_t l = 0; l < levels; l++) {
        level x = {plane, (size_t)width << l, halved(width, l), halved(height, l), kind,
                   border == T3R_WAVELET_PERIODIC, work, l == 0 ? colour : NULL, 0};
        level_forward(&x);
    }
    texture_plane(plane, width, height, levels, kind, texture_q4, (uint16_t *)work);
}

void t3r_wavelet_texture(const uint8_t *const colour[3], uint32_t width, uint32_t height, uint32_t levels,
                         t3r_wavelet kind, uint16_t *texture_q4, int16_t *plane, int16_t *work)
{
    t3r_wavelet_texture_border(colour, width, height, levels, kind, T3R_WAVELET_SYMMETRIC, texture_q4, plane, work);
}
