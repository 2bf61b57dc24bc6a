/* Integer lifting wavelets over several levels, in Mallat's layout.
 *
 * Why 16 bits suffice. Input: -2048 <= x <= 2032. A coefficient is a linear function of the input; its size is at
 * most 2048 times (2040 times, half the range, where the weights sum to 0, as they do with a high half in either
 * direction) the product, over the two directions, of the sum of absolute weights along one. The largest such
 * sums over all lengths, low half, high half and db2's d1 (wavelet_level.h):
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
 * and drives every kind with the images that attain it). */
#include "wavelet_level.h"

#include <string.h>

#include "kernels/wavelet_rows.h"

/* The row that belongs at a place of Mallat's order: low rows on top, high rows below them. */
static uint32_t row_at_place(const t3r_level *level, uint32_t place)
{
    uint32_t lows = (level->height + 1) / 2;
    return place < lows ? t3r_low_at(level, place) : t3r_high_at(level, place - lows);
}

/* Whether `place` is the least of its cycle of the permutation, so that each cycle is followed from one place. */
static bool starts_cycle(const t3r_level *level, uint32_t place)
{
    uint32_t at = row_at_place(level, place);

    /* at most height turns, and log(height) or so on average */
    while (at > place) {
        at = row_at_place(level, at);
    }
    return at == place;
}

/* Brings each row to its place in Mallat's order. */
static void order_rows(const t3r_level *level)
{
    size_t bytes = level->width * sizeof(int16_t);

    for (uint32_t first = 0; first < level->height; first++) {
        if (!starts_cycle(level, first)) {
            continue;
        }
        uint32_t at = first, next;
        memcpy(level->work, t3r_level_row(level, first), bytes);
        while ((next = row_at_place(level, at)) != first) {
            memcpy(t3r_level_row(level, at), t3r_level_row(level, next), bytes);
            at = next;
        }
        memcpy(t3r_level_row(level, at), level->work, bytes);
    }
}

/* And back: along a cycle, the first place's row goes to the next place, and that one's waits in the first. */
static void unorder_rows(const t3r_level *level)
{
    for (uint32_t first = 0; first < level->height; first++) {
        if (!starts_cycle(level, first)) {
            continue;
        }
        for (uint32_t at = row_at_place(level, first); at != first; at = row_at_place(level, at)) {
            t3r_row_swap(t3r_level_row(level, first), t3r_level_row(level, at), level->width);
        }
    }
}

void t3r_wavelet_forward_border(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                                t3r_wavelet_border border, int16_t *work)
{
    for (uint32_t l = 0; l < levels; l++) {
        t3r_level level = t3r_level_of(plane, width, height, l, kind, border, work);
        t3r_wavelet_level_forward(&level);
        order_rows(&level);
    }
}

void t3r_wavelet_inverse_border(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                                t3r_wavelet_border border, int16_t *work)
{
    for (uint32_t l = levels; l-- > 0;) {
        t3r_level level = t3r_level_of(plane, width, height, l, kind, border, work);
        unorder_rows(&level);
        t3r_wavelet_level_inverse(&level);
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
