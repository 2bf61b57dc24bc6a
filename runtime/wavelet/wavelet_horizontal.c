/* SPDX-License-Identifier: Apache-2.0 */
/* Horizontal lifting: splits a row into lows and highs in the working memory, lifts them there and stores them back,
 * lows first. */
#include "wavelet_level.h"

#include "core/memory.h"
#include "kernels/wavelet_rows.h"

#define PAD T3R_WAVELET_PAD

/* A split row, with room for one sample before and two after each half. */
typedef struct halves {
    int16_t *low, *high;
    uint32_t lows, highs;
    const t3r_kernels *kernels;
} halves;

static halves halves_of(const t3r_level *level)
{
    const uint32_t width = level->width;
    halves x;
    x.kernels = level->kernels;
    x.lows = (width + 1) / 2;
    x.highs = width / 2;
    x.low = level->work + PAD;
    x.high = x.low + (x.lows + PAD - 1) / PAD * PAD + 2 * PAD;
    return x;
}

static void store_halves(int16_t *row, halves x)
{
    memcpy(row, x.low, x.lows * sizeof(int16_t));
    memcpy(row + x.lows, x.high, x.highs * sizeof(int16_t));
}

/* ---- db2: low[n - 1] holds a[n], high[n - 1] b[n], then d1[n]; the row gets s[n], then d[n - 1] ---------------- */

static void forward_db2(int16_t *row, halves x)
{
    const uint32_t width = x.lows + x.highs, pairs = (width - 1) / 2;
    int16_t last = row[width - 1]; /* last sample of an even width, which has no pair */

    if (width % 2 == 0) {
        t3r_row_db2_last(&last, &row[width - 2], &row[width - 3], 1);
    }
    x.kernels->db2_split(x.low, x.high, row + 1, pairs);
    x.high[pairs] = x.high[pairs - 1];
    t3r_row_db2_first(row, x.low, 1);
    x.kernels->db2_join(row, row + x.lows, x.low, x.high, pairs);
    if (width % 2 == 0) {
        row[width - 1] = last;
    }
}

/* ---- Haar and CDF 5/3: lows are the even samples, highs the odd ones ------------------------------------ */

static void forward_haar(int16_t *row, halves x)
{
    x.kernels->split_row(x.low, x.high, row, x.lows + x.highs);
    x.kernels->subtract_row(x.high, x.low, x.highs);
    x.kernels->haar_update(x.low, x.high, x.highs);
    store_halves(row, x);
}

/* Pads the highs at both ends: each even sample needs an odd one on both sides. */
static void repeat_odds(halves x)
{
    x.high[-1] = x.high[0];
    x.high[x.highs] = x.high[x.highs - 1];
}

/* Pads the lows: the last odd sample needs an even one after it. */
static void repeat_even(halves x)
{
    if (x.lows == x.highs) {
        x.low[x.highs] = x.low[x.highs - 1];
    }
}

static void forward_cdf53(int16_t *row, halves x)
{
    x.kernels->split_row(x.low, x.high, row, x.lows + x.highs);
    repeat_even(x);
    x.kernels->cdf53_predict(x.high, x.low, x.low + 1, x.highs);
    repeat_odds(x);
    x.kernels->cdf53_update(x.low, x.high - 1, x.high, x.lows);
    store_halves(row, x);
}

/* --------------------------------------------------------------------------------------------------------- */

void t3r_wavelet_row_forward(const t3r_level *level, int16_t *row)
{
    halves x = halves_of(level);

    if (level->width < 2) {
        return;
    }
    if (t3r_kind_of(level) == T3R_WAVELET_HAAR) {
        forward_haar(row, x);
    } else if (t3r_kind_of(level) == T3R_WAVELET_CDF53) {
        forward_cdf53(row, x);
    } else if (level->width == 2) {
        t3r_row_db2_pair(row, row + 1, 1);
    } else {
        forward_db2(row, x);
    }
}
