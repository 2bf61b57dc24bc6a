/* Integer lifting wavelets, and the texture energy that they measure.
 *
 * One level of db2 on a line of samples x[0] x[1] ... pairs a[n] = x[2 n - 1] with b[n] = x[2 n]:
 *     d1[n]    = b[n] - sqrt(3) a[n]
 *     s[n]     = a[n] + sqrt(3)/4 d1[n] - (2 - sqrt 3)/4 d1[n + 1]     low n, over x[2 n - 1 .. 2 n + 2]
 *     d[n - 1] = d1[n] + s[n - 1]                                     high n - 1, over x[2 n - 3 .. 2 n]
 * which is db2 without its last scaling, orthonormal = 1.93185 s and 0.51764 d ((sqrt 3 +- 1) / sqrt 2), each
 * coefficient centred on the two samples 2 n, 2 n + 1 that it stands for. The ends of a line:
 *     s[0] = x[0] - (2 - sqrt 3) x[1], what s is for a straight line;
 *     behind the last pair its d1 is repeated;
 *     an even length N leaves x[N - 1]: its d is the second difference x[N - 1] - 2 x[N - 2] + x[N - 3];
 *     two samples alone are one pair: d1 = x[1] - sqrt(3) x[0], s = x[0] + ((sqrt 3 - 1)/2) d1, d = d1 + s.
 * Lows keep the gain sqrt 3 - 1 for constants, highs 0, at the ends too.
 *
 * Why 16 bits suffice. Input: -2048 <= x <= 2032. A coefficient is a linear function of the input; its size is at
 * most 2048 times (2040 times, half the range, where the weights sum to 0, as they do with a high half in either
 * direction) the product, over the two directions, of the sum of absolute weights along one. The largest such
 * sums over all lengths, low half, high half and db2's d1:
 *     level    db2 low   high    d1     5/3 low   high    Haar low   high
 *       1       1.268   4.000  2.733     1.500   2.000       1        2
 *       2       1.500   3.402  2.929     1.625   2.500       1        2
 *       3       1.634   3.131  3.121     1.688   2.750       1        2
 *       4       1.732   2.821  3.212     1.698   2.805       1        2
 *       5       1.804   2.769  3.281     1.707   2.827       1        2
 * The largest value stored is db2's first D, 4^2 x 2040 = 32,640. Roundings move it by less than 8: along a row d
 * is off by at most 1.75 (three roundings of a half and 0.5 of d1's), four such weights and 1 more down the column.
 * Everything else stays below 24,000 and is off by less than 100 after five levels. Sums inside one expression
 * may pass 16 bits (o - 2 e); they wrap and the result is right (tests/unit/test_wavelet.c recomputes the table
 * and drives every kind with the images that attain it).
 *
 * Texture: |h| + |v| <= 2 x 10,430; 0.268 |d| <= 8,750 on level 1, so their sum is below 2^15; on the others
 * |d| <= 23,620. */
#include "wavelet.h"

#include <stdbool.h>
#include <string.h>

#include "fixed.h"
#include "kernels/wavelet_rows.h"

#define PAD 8u /* room for a repeated neighbour, kept at 16 bytes so that rows stay aligned */

/* A split row, with room for a sample before and two behind each half. */
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

static void store_halves(int16_t *row, uint32_t width, const int16_t *low, const int16_t *high)
{
    uint32_t lows = (width + 1) / 2;
    memcpy(row, low, lows * sizeof(int16_t));
    memcpy(row + lows, high, (width - lows) * sizeof(int16_t));
}

static void load_halves(const int16_t *row, uint32_t width, int16_t *low, int16_t *high)
{
    uint32_t lows = (width + 1) / 2;
    memcpy(low, row, lows * sizeof(int16_t));
    memcpy(high, row + lows, (width - lows) * sizeof(int16_t));
}

/* ---- one row ---------------------------------------------------------------------------------------- */

/* db2's lanes are its own (see above), so it splits a row by itself: low gets x[0], x[1], x[3] ..., high x[2],
 * x[4] ... The last sample of an even length then stands behind the lows; it belongs to the highs. */

/* A line of two samples; along columns, `count` of them side by side. */
static void pair_forward_db2(int16_t *low, int16_t *high, uint32_t count)
{
    t3r_row_db2_predict(high, low, count);
    t3r_row_db2_pair_update(low, high, count);
    t3r_row_add(high, low, count);
}

static void pair_inverse_db2(int16_t *low, int16_t *high, uint32_t count)
{
    t3r_row_subtract(high, low, count);
    t3r_row_db2_pair_unupdate(low, high, count);
    t3r_row_db2_unpredict(high, low, count);
}

static void row_forward_db2(int16_t *row, uint32_t width, int16_t *low, int16_t *high)
{
    uint32_t pairs = (width - 1) / 2;
    int16_t last = 0;

    if (width == 2) {
        pair_forward_db2(row, row + 1, 1);
        return;
    }
    t3r_row_split(low + 1, high, row + 1, width - 1);
    low[0] = row[0];
    if (width % 2 == 0) {
        last = low[pairs + 1];
        t3r_row_db2_last(&last, &high[pairs - 1], &low[pairs], 1);
    }
    t3r_row_db2_first(low, low + 1, 1);
    t3r_row_db2_predict(high, low + 1, pairs);
    high[pairs] = high[pairs - 1];
    t3r_row_db2_update(low + 1, high, high + 1, pairs);
    t3r_row_add(high, low, pairs);
    high[pairs] = last;
    store_halves(row, width, low, high);
}

static void row_inverse_db2(int16_t *row, uint32_t width, int16_t *low, int16_t *high)
{
    uint32_t pairs = (width - 1) / 2;

    if (width == 2) {
        pair_inverse_db2(row, row + 1, 1);
        return;
    }
    load_halves(row, width, low, high);
    int16_t last = width % 2 == 0 ? high[pairs] : 0;
    t3r_row_subtract(high, low, pairs);
    high[pairs] = high[pairs - 1];
    t3r_row_db2_unupdate(low + 1, high, high + 1, pairs);
    t3r_row_db2_unpredict(high, low + 1, pairs);
    t3r_row_db2_unfirst(low, low + 1, 1);
    if (width % 2 == 0) {
        t3r_row_db2_unlast(&last, &high[pairs - 1], &low[pairs], 1);
        low[pairs + 1] = last;
    }
    row[0] = low[0];
    t3r_row_join(row + 1, low + 1, high, width - 1);
}

/* Periodic: x[N - 1] and x[0] are a pair, and lie where the first low and the last high do. Even lengths. */
static void row_forward_db2_periodic(int16_t *row, uint32_t width, int16_t *low, int16_t *high)
{
    uint32_t pairs = width / 2;

    if (width == 2) {
        pair_forward_db2(row, row + 1, 1);
        return;
    }
    t3r_row_split(low + 1, high, row + 1, width - 1);
    low[0] = row[width - 1];
    high[pairs - 1] = row[0];
    t3r_row_db2_predict(high, low + 1, pairs - 1);
    t3r_row_db2_predict(high + pairs - 1, low, 1);
    t3r_row_db2_update(low + 1, high, high + 1, pairs - 1);
    t3r_row_db2_update(low, high + pairs - 1, high, 1);
    t3r_row_add(high, low, pairs);
    store_halves(row, width, low, high);
}

static void row_inverse_db2_periodic(int16_t *row, uint32_t width, int16_t *low, int16_t *high)
{
    uint32_t pairs = width / 2;

    if (width == 2) {
        pair_inverse_db2(row, row + 1, 1);
        return;
    }
    load_halves(row, width, low, high);
    t3r_row_subtract(high, low, pairs);
    t3r_row_db2_unupdate(low + 1, high, high + 1, pairs - 1);
    t3r_row_db2_unupdate(low, high + pairs - 1, high, 1);
    t3r_row_db2_unpredict(high, low + 1, pairs - 1);
    t3r_row_db2_unpredict(high + pairs - 1, low, 1);
    row[0] = high[pairs - 1];
    low[pairs] = low[0];
    t3r_row_join(row + 1, low + 1, high, width - 1);
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

static void row_forward_haar(int16_t *row, uint32_t width, halves x)
{
    t3r_row_split(x.even, x.odd, row, width);
    t3r_row_subtract(x.odd, x.even, x.odds);
    t3r_row_haar_update(x.even, x.odd, x.odds);
    store_halves(row, width, x.even, x.odd);
}

static void row_inverse_haar(int16_t *row, uint32_t width, halves x)
{
    load_halves(row, width, x.even, x.odd);
    t3r_row_haar_unupdate(x.even, x.odd, x.odds);
    t3r_row_add(x.odd, x.even, x.odds);
    t3r_row_join(row, x.even, x.odd, width);
}

static void row_forward_cdf53(int16_t *row, uint32_t width, halves x, bool periodic)
{
    t3r_row_split(x.even, x.odd, row, width);
    repeat_even(x, periodic);
    t3r_row_cdf53_predict(x.odd, x.even, x.even + 1, x.odds);
    repeat_odds(x, periodic);
    t3r_row_cdf53_update(x.even, x.odd - 1, x.odd, x.evens);
    store_halves(row, width, x.even, x.odd);
}

static void row_inverse_cdf53(int16_t *row, uint32_t width, halves x, bool periodic)
{
    load_halves(row, width, x.even, x.odd);
    repeat_odds(x, periodic);
    t3r_row_cdf53_unupdate(x.even, x.odd - 1, x.odd, x.evens);
    repeat_even(x, periodic);
    t3r_row_cdf53_unpredict(x.odd, x.even, x.even + 1, x.odds);
    t3r_row_join(row, x.even, x.odd, width);
}

static void row_forward(int16_t *row, uint32_t width, t3r_wavelet kind, bool periodic, int16_t *work)
{
    halves x = halves_in(work, width);

    if (width < 2) {
        return;
    }
    switch (kind) {
    case T3R_WAVELET_HAAR:
        row_forward_haar(row, width, x);
        break;
    case T3R_WAVELET_CDF53:
        row_forward_cdf53(row, width, x, periodic);
        break;
    default:
        (periodic ? row_forward_db2_periodic : row_forward_db2)(row, width, x.even, x.odd);
        break;
    }
}

static void row_inverse(int16_t *row, uint32_t width, t3r_wavelet kind, bool periodic, int16_t *work)
{
    halves x = halves_in(work, width);

    if (width < 2) {
        return;
    }
    switch (kind) {
    case T3R_WAVELET_HAAR:
        row_inverse_haar(row, width, x);
        break;
    case T3R_WAVELET_CDF53:
        row_inverse_cdf53(row, width, x, periodic);
        break;
    default:
        (periodic ? row_inverse_db2_periodic : row_inverse_db2)(row, width, x.even, x.odd);
        break;
    }
}

/* ---- one level, rows staying where they are ----------------------------------------------------------- */

/* Lines of one direction in lifting order, and where their low and high coefficients end up among the samples. */
static uint32_t low_at(t3r_wavelet kind, uint32_t n)
{
    if (kind == T3R_WAVELET_DB2) {
        return n == 0 ? 0 : 2 * n - 1;
    }
    return 2 * n;
}

static uint32_t high_at(t3r_wavelet kind, uint32_t length, uint32_t n)
{
    return kind == T3R_WAVELET_DB2 ? T3R_MIN(2 * n + 2, length - 1) : 2 * n + 1;
}

/* A level's rows. Lifting runs down the rows and touches each while it is in cache; rows are made just ahead. */
typedef struct level {
    int16_t *plane;
    size_t stride; /* samples from row to row of the plane */
    uint32_t width, height;
    uint32_t before; /* levels whose rows stayed in place: the rows are the lows of the last of them */
    t3r_wavelet kind;
    bool periodic;
    int16_t *work;
    const uint8_t *const *colour; /* the image whose luma fills the plane; NULL: it is filled */
    uint32_t ready;               /* rows [0, ready) are horizontally transformed */
} level;

/* low_at() applied `levels` times */
static uint32_t low_row(t3r_wavelet kind, uint32_t levels, uint32_t n)
{
    if (kind == T3R_WAVELET_DB2) {
        return n == 0 ? 0 : ((n - 1) << levels) + 1;
    }
    return n << levels;
}

static int16_t *row_of(const level *x, uint32_t n)
{
    return x->plane + low_row(x->kind, x->before, n) * x->stride;
}

static void make_rows(level *x, uint32_t end)
{
    for (; x->ready < T3R_MIN(end, x->height); x->ready++) {
        int16_t *row = row_of(x, x->ready);
        if (x->colour != NULL) {
            size_t at = (size_t)x->ready * x->width;
            t3r_row_luma(row, x->colour[0] + at, x->colour[1] + at, x->colour[2] + at, x->width);
        }
        row_forward(row, x->width, x->kind, x->periodic, x->work);
    }
}

/* a[n] and b[n] of db2 */
static int16_t *a_row(const level *x, uint32_t n)
{
    return row_of(x, 2 * n - 1);
}

static int16_t *b_row(const level *x, uint32_t n)
{
    return row_of(x, 2 * n);
}

/* The low row before a_row(n). */
static const int16_t *low_before(const level *x, uint32_t n)
{
    return n > 1 ? a_row(x, n - 1) : row_of(x, 0);
}

/* d1 of pair n; the last pair first serves the row that an even height leaves behind it. */
static void predict_pair(level *x, uint32_t n)
{
    make_rows(x, 2 * n + 2);
    if (2 * n + 2 == x->height) {
        t3r_row_db2_last(row_of(x, 2 * n + 1), b_row(x, n), a_row(x, n), x->width);
    }
    t3r_row_db2_predict(b_row(x, n), a_row(x, n), x->width);
}

static void columns_forward_db2(level *x)
{
    uint32_t pairs = (x->height - 1) / 2;

    make_rows(x, 2);
    if (x->height == 2) {
        pair_forward_db2(row_of(x, 0), row_of(x, 1), x->width);
        return;
    }
    t3r_row_db2_first(row_of(x, 0), row_of(x, 1), x->width);
    predict_pair(x, 1);
    for (uint32_t n = 1; n <= pairs; n++) {
        if (n < pairs) {
            predict_pair(x, n + 1);
        }
        t3r_row_db2_update(a_row(x, n), b_row(x, n), b_row(x, T3R_MIN(n + 1, pairs)), x->width);
        t3r_row_add(b_row(x, n), low_before(x, n), x->width);
    }
}

static void columns_inverse_db2(level *x)
{
    uint32_t pairs = (x->height - 1) / 2;

    if (x->height == 2) {
        pair_inverse_db2(row_of(x, 0), row_of(x, 1), x->width);
        return;
    }
    t3r_row_subtract(b_row(x, 1), row_of(x, 0), x->width);
    for (uint32_t n = 1; n <= pairs; n++) {
        if (n < pairs) {
            t3r_row_subtract(b_row(x, n + 1), a_row(x, n), x->width);
        }
        t3r_row_db2_unupdate(a_row(x, n), b_row(x, n), b_row(x, T3R_MIN(n + 1, pairs)), x->width);
        t3r_row_db2_unpredict(b_row(x, n), a_row(x, n), x->width);
    }
    if (x->height % 2 == 0) {
        t3r_row_db2_unlast(row_of(x, x->height - 1), b_row(x, pairs), a_row(x, pairs), x->width);
    }
    t3r_row_db2_unfirst(row_of(x, 0), row_of(x, 1), x->width);
}

/* Brings the pair x[N - 1], x[0] to where the first low and the last high belong, and back. */
static void swap_ends(const level *x)
{
    size_t bytes = x->width * sizeof(int16_t);
    int16_t *first = row_of(x, 0), *last = row_of(x, x->height - 1);
    memcpy(x->work, first, bytes);
    memcpy(first, last, bytes);
    memcpy(last, x->work, bytes);
}

/* b[n] of the periodic pairs 1..N / 2 */
static int16_t *b_row_periodic(const level *x, uint32_t n)
{
    return 2 * n < x->height ? b_row(x, n) : row_of(x, x->height - 1);
}

static void columns_forward_db2_periodic(level *x)
{
    uint32_t pairs = x->height / 2;

    make_rows(x, x->height);
    if (x->height == 2) {
        pair_forward_db2(row_of(x, 0), row_of(x, 1), x->width);
        return;
    }
    swap_ends(x);
    for (uint32_t n = 1; n <= pairs; n++) {
        t3r_row_db2_predict(b_row_periodic(x, n), n < pairs ? a_row(x, n) : row_of(x, 0), x->width);
    }
    for (uint32_t n = 1; n < pairs; n++) {
        t3r_row_db2_update(a_row(x, n), b_row(x, n), b_row_periodic(x, n + 1), x->width);
    }
    t3r_row_db2_update(row_of(x, 0), b_row_periodic(x, pairs), b_row(x, 1), x->width);
    for (uint32_t n = 1; n <= pairs; n++) {
        t3r_row_add(b_row_periodic(x, n), low_before(x, n), x->width);
    }
}

static void columns_inverse_db2_periodic(level *x)
{
    uint32_t pairs = x->height / 2;

    if (x->height == 2) {
        pair_inverse_db2(row_of(x, 0), row_of(x, 1), x->width);
        return;
    }
    for (uint32_t n = 1; n <= pairs; n++) {
        t3r_row_subtract(b_row_periodic(x, n), low_before(x, n), x->width);
    }
    t3r_row_db2_unupdate(row_of(x, 0), b_row_periodic(x, pairs), b_row(x, 1), x->width);
    for (uint32_t n = 1; n < pairs; n++) {
        t3r_row_db2_unupdate(a_row(x, n), b_row(x, n), b_row_periodic(x, n + 1), x->width);
    }
    for (uint32_t n = 1; n <= pairs; n++) {
        t3r_row_db2_unpredict(b_row_periodic(x, n), n < pairs ? a_row(x, n) : row_of(x, 0), x->width);
    }
    swap_ends(x);
}

static int16_t *even_row(const level *x, uint32_t n)
{
    return row_of(x, 2 * n);
}

static int16_t *odd_row(const level *x, uint32_t n)
{
    return row_of(x, 2 * n + 1);
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
        (x->periodic ? columns_forward_db2_periodic : columns_forward_db2)(x);
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
            (x->periodic ? columns_inverse_db2_periodic : columns_inverse_db2)(x);
            break;
        }
    }
    for (uint32_t y = 0; y < x->height; y++) {
        row_inverse(row_of(x, y), x->width, x->kind, x->periodic, x->work);
    }
}

/* ---- Mallat's layout --------------------------------------------------------------------------------- */

/* The row that belongs at a place of Mallat's order, and the place of a row. */
static uint32_t row_at_place(const level *x, uint32_t place)
{
    uint32_t lows = (x->height + 1) / 2;
    return place < lows ? low_at(x->kind, place) : high_at(x->kind, x->height, place - lows);
}

static uint32_t place_of_row(const level *x, uint32_t row)
{
    uint32_t lows = (x->height + 1) / 2;

    if (x->kind != T3R_WAVELET_DB2) {
        return row / 2 + (row % 2 != 0 ? lows : 0);
    }
    if (row % 2 != 0) {
        /* an even height's last row is its last high */
        return row + 1 == x->height ? row : (row + 1) / 2;
    }
    return row == 0 ? 0 : lows + row / 2 - 1;
}

/* Brings low rows to the top and high rows below them, or back, following each cycle of the permutation once. */
static void order_rows(const level *x, bool back)
{
    size_t bytes = x->width * sizeof(int16_t);
    int16_t *held = x->work;
    uint16_t *moved = (uint16_t *)(x->work + x->width);

    memset(moved, 0, (x->height / 16 + 1) * sizeof(uint16_t));
    for (uint32_t first = 0; first < x->height; first++) {
        if ((moved[first / 16] >> first % 16 & 1) != 0) {
            continue;
        }
        memcpy(held, x->plane + first * x->stride, bytes);
        uint32_t to = first;
        /* at most height turns over all cycles */
        for (;;) {
            uint32_t from = back ? place_of_row(x, to) : row_at_place(x, to);
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
        level x = {plane, width, halved(width, l), halved(height, l), 0, kind, border == T3R_WAVELET_PERIODIC, work,
                   NULL,  0};
        level_forward(&x);
        order_rows(&x, false);
    }
}

void t3r_wavelet_inverse_border(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                                t3r_wavelet_border border, int16_t *work)
{
    for (uint32_t l = levels; l-- > 0;) {
        level x = {plane, width, halved(width, l), halved(height, l), 0, kind, border == T3R_WAVELET_PERIODIC, work,
                   NULL,  0};
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
static void texture_row(const int16_t *plane, uint32_t width, uint32_t height, uint32_t l, uint32_t n, t3r_wavelet kind,
                        uint16_t *out)
{
    uint32_t across = halved(width, l - 1), down = halved(height, l - 1);
    uint32_t lows = (across + 1) / 2, highs = across / 2;
    bool paired = n < down / 2; /* an odd height's last low row has no high row */
    const int16_t *upper = plane + (size_t)low_row(kind, l - 1, low_at(kind, n)) * width;
    const int16_t *lower = paired ? plane + (size_t)low_row(kind, l - 1, high_at(kind, down, n)) * width : upper;
    uint32_t gain = gain_q8[kind][l - 1];
    uint32_t d_gain = l > 1 ? gain_q8[kind][l - 2] : 0;

    if (!paired) {
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
        level x = {plane,
                   width,
                   halved(width, l),
                   halved(height, l),
                   l,
                   kind,
                   border == T3R_WAVELET_PERIODIC,
                   work,
                   l == 0 ? colour : NULL,
                   0};
        level_forward(&x);
    }
    texture_plane(plane, width, height, levels, kind, texture_q4, (uint16_t *)work);
}

void t3r_wavelet_texture(const uint8_t *const colour[3], uint32_t width, uint32_t height, uint32_t levels,
                         t3r_wavelet kind, uint16_t *texture_q4, int16_t *plane, int16_t *work)
{
    t3r_wavelet_texture_border(colour, width, height, levels, kind, T3R_WAVELET_SYMMETRIC, texture_q4, plane, work);
}
