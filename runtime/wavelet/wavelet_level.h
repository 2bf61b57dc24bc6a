/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the files of the wavelet stage: one level of a transform, how a line is lifted, and where its coefficients
 * lie.
 *
 * db2 on a line of samples x[0] x[1] ... pairs a[n] = x[2 n - 1] with b[n] = x[2 n]:
 *     d1[n]    = b[n] - sqrt(3) a[n]
 *     s[n]     = a[n] + sqrt(3)/4 d1[n] - (2 - sqrt 3)/4 d1[n + 1]     low n, over x[2 n - 1 .. 2 n + 2]
 *     d[n - 1] = d1[n] + s[n - 1]                                     high n - 1, over x[2 n - 3 .. 2 n]
 * which is db2 without its last scaling, orthonormal = 1.93185 s and 0.51764 d ((sqrt 3 +- 1) / sqrt 2). Each
 * coefficient is centred on the two samples 2 n, 2 n + 1 that it represents. The ends of a line:
 *     s[0] = x[0] - (2 - sqrt 3) x[1], which is s of a straight line;
 *     after the last pair its d1 is repeated;
 *     an even length N leaves x[N - 1]: its d is the second difference x[N - 1] - 2 x[N - 2] + x[N - 3];
 *     two samples alone are one pair: d1 = x[1] - sqrt(3) x[0], s = x[0] + ((sqrt 3 - 1)/2) d1, d = d1 + s.
 * Lows keep the gain sqrt 3 - 1 for constants, highs 0, at the ends too.
 *
 * Haar and CDF 5/3 take even samples for lows and odd ones for highs; kernels/wavelet_rows.h has their steps.
 *
 * Why 16 bits suffice. Input: -2048 <= x <= 2032. A coefficient is a linear function of the input. Its size is at most
 * 2048 times the product, over the two directions, of the sum of absolute weights along one. Where the weights sum to
 * 0, as they do with a high half in either direction, it is 2040 times that product: 2040 is half the input's range.
 * These are the largest such sums over all lengths, of the low half, the high half and db2's d1.
 *
 *     level    db2 low   high    d1     5/3 low   high    Haar low   high
 *       1       1.268   4.000  2.733     1.500   2.000       1        2
 *       2       1.500   3.402  2.929     1.625   2.500       1        2
 *       3       1.634   3.131  3.121     1.688   2.750       1        2
 *       4       1.732   2.821  3.212     1.698   2.805       1        2
 *       5       1.804   2.769  3.281     1.707   2.827       1        2
 * The largest value stored is db2's first D, 4^2 x 2040 = 32,640. Roundings move it by less than 8: along a row d
 * is off by at most 1.75 (three roundings of a half and 0.5 of d1's), four such weights and 1 more down the column.
 * Everything else stays below 24,000 and is off by less than 100 after five levels. Sums inside one expression
 * may pass 16 bits (o - 2 e); they wrap and the result is right (tests/unit/wavelet/test_wavelet.c recomputes the table
 * and drives every kind with the images that attain it). */
#ifndef T3R_WAVELET_LEVEL_H
#define T3R_WAVELET_LEVEL_H

#include <stddef.h>
#include <stdint.h>

#include "core/fixed.h"
#include "trim3r.h"
#include "wavelet.h"

/* The rows of one level: the first rows of the plane or, if earlier levels kept their rows in place, the low rows of
 * the last of them. */
typedef struct t3r_level {
    const t3r_kernels *kernels;
    int16_t *plane;
    size_t stride;          /* samples between rows of the plane */
    uint32_t width, height; /* of this level */
    uint32_t in_place;      /* number of earlier levels that kept their rows in place */
    t3r_wavelet kind;
    int16_t *work;                /* T3R_WAVELET_ROW_BYTES(width) of the first level */
    const uint8_t *const *colour; /* image whose luma fills the plane; NULL: the plane is filled */
} t3r_level;

/* Returns the wavelet, a constant in builds with a single one. */
static inline t3r_wavelet t3r_kind_of(const t3r_level *level)
{
    return T3R_FEATURE_EXTRAS ? level->kind : T3R_WAVELET_DB2;
}

/* Length of one side after `levels` halvings that keep the odd sample. */
static inline uint32_t t3r_halved(uint32_t side, uint32_t levels)
{
    return (side + (1u << levels) - 1) >> levels;
}

/* Returns level `index` (from 0) of a transform of a filled plane whose earlier levels moved their low rows to the
 * top. */
static inline t3r_level t3r_level_of(int16_t *plane, uint32_t width, uint32_t height, uint32_t index, t3r_wavelet kind,
                                     int16_t *work)
{
    t3r_level level = {
        .plane = plane,
        .stride = width,
        .width = t3r_halved(width, index),
        .height = t3r_halved(height, index),
        .kind = kind,
        .work = work,
    };
    return level;
}

/* Return the row of the level in which vertical lifting stores low n and high n. With db2, low n replaces a[n] and high
 * n replaces b[n + 1]; the last row of an even height is its last high. */
static inline uint32_t t3r_low_at(const t3r_level *level, uint32_t n)
{
    if (t3r_kind_of(level) == T3R_WAVELET_DB2) {
        return n == 0 ? 0 : 2 * n - 1;
    }
    return 2 * n;
}

static inline uint32_t t3r_high_at(const t3r_level *level, uint32_t n)
{
    return t3r_kind_of(level) == T3R_WAVELET_DB2 ? T3R_MIN(2 * n + 2, level->height - 1) : 2 * n + 1;
}

/* Returns row n of the level in the plane: t3r_low_at() once for each level in place. */
static inline int16_t *t3r_level_row(const t3r_level *level, uint32_t n)
{
    if (t3r_kind_of(level) == T3R_WAVELET_DB2 && n > 0) {
        return level->plane + (((n - 1) << level->in_place) + 1) * level->stride;
    }
    return level->plane + (n << level->in_place) * level->stride;
}

static inline int16_t *t3r_low_row(const t3r_level *level, uint32_t n)
{
    return t3r_level_row(level, t3r_low_at(level, n));
}

static inline int16_t *t3r_high_row(const t3r_level *level, uint32_t n)
{
    return t3r_level_row(level, t3r_high_at(level, n));
}

/* Lifts one row of the level horizontally, in place: its lows, then its highs. A row of one sample doesn't change. */
void t3r_wavelet_row_forward(const t3r_level *level, int16_t *row);

/* Transforms one level horizontally and vertically. Rows stay where t3r_low_at() and t3r_high_at() say. */
void t3r_wavelet_level_forward(const t3r_level *level);

#endif
