/* SPDX-License-Identifier: Apache-2.0 */
/* Vertical lifting of a level: lifts whole rows against each other. It runs down the rows and makes each row (luma and
 * horizontal lifting) just before it is first needed, so that the work stays in cache. */
#include "wavelet_level.h"

#include "kernels/wavelet_rows.h"

static void make_row(const t3r_level *x, uint32_t y)
{
    int16_t *row = t3r_level_row(x, y);

    if (x->colour != NULL) {
        size_t at = (size_t)y * x->width;
        x->kernels->luma_row(row, x->colour[0] + at, x->colour[1] + at, x->colour[2] + at, x->width);
    }
    t3r_wavelet_row_forward(x, row);
}

/* ---- db2 -------------------------------------------------------------------------------------------------- */

/* Returns the row that holds a[n], then s[n]. */
static int16_t *a_row(const t3r_level *x, uint32_t n)
{
    return t3r_low_row(x, n);
}

/* Returns the row that holds b[n], then d1[n], then d[n - 1]. */
static int16_t *b_row(const t3r_level *x, uint32_t n)
{
    return t3r_high_row(x, n - 1);
}

/* Computes d1 of pair n. The last pair of an even height first predicts the unpaired row after it. */
static void predict_pair(const t3r_level *x, uint32_t n)
{
    make_row(x, 2 * n - 1);
    make_row(x, 2 * n);
    if (2 * n + 2 == x->height) {
        make_row(x, 2 * n + 1);
        t3r_row_db2_last(t3r_level_row(x, 2 * n + 1), b_row(x, n), a_row(x, n), x->width);
    }
    x->kernels->db2_predict(b_row(x, n), a_row(x, n), x->width);
}

static void forward_db2(const t3r_level *x)
{
    uint32_t pairs = (x->height - 1) / 2;

    make_row(x, 0);
    predict_pair(x, 1);
    t3r_row_db2_first(a_row(x, 0), a_row(x, 1), x->width);
    for (uint32_t n = 1; n <= pairs; n++) {
        if (n < pairs) {
            predict_pair(x, n + 1);
        }
        x->kernels->db2_lift(a_row(x, n), b_row(x, n), b_row(x, T3R_MIN(n + 1, pairs)), a_row(x, n - 1), x->width);
    }
}

/* ---- Haar and CDF 5/3 ------------------------------------------------------------------------------------- */

static void forward_haar(const t3r_level *x)
{
    uint32_t pairs = x->height / 2;

    for (uint32_t n = 0; n < pairs; n++) {
        make_row(x, 2 * n);
        make_row(x, 2 * n + 1);
        x->kernels->subtract_row(t3r_high_row(x, n), t3r_low_row(x, n), x->width);
        x->kernels->haar_update(t3r_low_row(x, n), t3r_high_row(x, n), x->width);
    }
    if (x->height % 2 != 0) {
        make_row(x, 2 * pairs);
    }
}

/* Returns the even row after odd row n, or at the end the one before it. */
static const int16_t *even_behind(const t3r_level *x, uint32_t n)
{
    if (2 * n + 2 < x->height) {
        return t3r_low_row(x, n + 1);
    }
    return t3r_low_row(x, n);
}

static void forward_cdf53(const t3r_level *x)
{
    uint32_t pairs = x->height / 2;

    make_row(x, 0);
    for (uint32_t n = 0; n < pairs; n++) {
        make_row(x, 2 * n + 1);
        if (2 * n + 2 < x->height) {
            make_row(x, 2 * n + 2);
        }
        x->kernels->cdf53_predict(t3r_high_row(x, n), t3r_low_row(x, n), even_behind(x, n), x->width);
        if (n > 0) {
            x->kernels->cdf53_update(t3r_low_row(x, n), t3r_high_row(x, n - 1), t3r_high_row(x, n), x->width);
        } else {
            x->kernels->cdf53_update(t3r_low_row(x, 0), t3r_high_row(x, 0), t3r_high_row(x, 0), x->width);
        }
    }
    if (x->height % 2 != 0) {
        const int16_t *last = t3r_high_row(x, pairs - 1);
        x->kernels->cdf53_update(t3r_low_row(x, pairs), last, last, x->width);
    }
}

/* --------------------------------------------------------------------------------------------------------- */

void t3r_wavelet_level_forward(const t3r_level *x)
{
    if (x->height < 2) {
        make_row(x, 0);
    } else if (t3r_kind_of(x) == T3R_WAVELET_HAAR) {
        forward_haar(x);
    } else if (t3r_kind_of(x) == T3R_WAVELET_CDF53) {
        forward_cdf53(x);
    } else if (x->height == 2) {
        make_row(x, 0);
        make_row(x, 1);
        t3r_row_db2_pair(t3r_level_row(x, 0), t3r_level_row(x, 1), x->width);
    } else {
        forward_db2(x);
    }
}
