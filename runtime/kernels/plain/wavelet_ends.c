/* SPDX-License-Identifier: Apache-2.0 */
/* The first and last rows of a db2 transform. They occur once per plane, so variants would gain little. */
#include "core/fixed.h"
#include "kernels/wavelet_rows.h"

void t3r_row_db2_first(int16_t *restrict x0, const int16_t *restrict x1, size_t count)
{
    for (size_t i = 0; i < count; i++) {
        x0[i] = (int16_t)(x0[i] - t3r_mulr_q15_small(x1[i], T3R_DB2_PREDICT_Q15));
    }
}

void t3r_row_db2_last(int16_t *restrict last, const int16_t *restrict before, const int16_t *restrict before_that,
                      size_t count)
{
    for (size_t i = 0; i < count; i++) {
        last[i] = (int16_t)(last[i] - 2 * before[i] + before_that[i]);
    }
}

void t3r_row_db2_pair(int16_t *restrict low, int16_t *restrict high, size_t count)
{
    t3r_db2_predict_c(high, low, count);
    for (size_t i = 0; i < count; i++) {
        low[i] = (int16_t)(low[i] + t3r_mulr_q15_small(high[i], T3R_DB2_UPDATE_PAIR_Q15));
        high[i] = (int16_t)(high[i] + low[i]);
    }
}
