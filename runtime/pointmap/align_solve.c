/* SPDX-License-Identifier: Apache-2.0 */
#include "align_solve.h"

#include "core/fixed.h"

#define N T3R_ALIGN_UNKNOWNS
#define PIVOT_LEAST (INT64_C(1) << 14) /* with diagonals of at least 2^28 */
#define FACTOR_MOST (INT64_C(1) << 28) /* Q20 */
#define VALUE_MOST (INT64_C(1) << 33)

/* Returns the shift that brings x > 0 into 2^bits..2^(bits + 1) - 1. */
static int32_t shift_to(int64_t x, int32_t bits)
{
    return bits - (int32_t)t3r_msb64((uint64_t)x);
}

/* Scales A so that its diagonal is in 2^28..2^30 - 1, x_i and b_i by 2^shift[i]. Off-diagonal entries are no larger. */
static void scale(const int64_t a[T3R_ALIGN_PRODUCTS], int64_t m[N][N], int32_t shift[N])
{
    for (uint32_t i = 0, at = 0; i < N; at += N - i++) {
        const int32_t twice = shift_to(a[at] > 0 ? a[at] : 1, 29);
        shift[i] = twice >> 1; /* floor: 2^28..2^29.99 */
    }
    for (uint32_t i = 0, at = 0; i < N; i++) {
        for (uint32_t j = i; j < N; j++) {
            m[j][i] = t3r_scale64(a[at++], shift[i] + shift[j]);
        }
    }
}

/* Factors the lower triangle into L D L^T in place: D on the diagonal, L Q20 below. Products stay below 2^62. */
static void factor(int64_t m[N][N])
{
    for (uint32_t j = 0; j < N; j++) {
        int64_t scaled[N] = {0}; /* L_jk D_k */
        int64_t pivot = m[j][j];
        for (uint32_t k = 0; k < j; k++) {
            scaled[k] = t3r_clamp64(t3r_round_shift64(m[j][k] * m[k][k], 20), -VALUE_MOST, VALUE_MOST);
            pivot -= t3r_round_shift64(m[j][k] * scaled[k], 20);
        }
        m[j][j] = T3R_MAX(pivot, PIVOT_LEAST);
        for (uint32_t i = j + 1; i < N; i++) {
            int64_t rest = m[i][j];
            for (uint32_t k = 0; k < j; k++) {
                rest -= t3r_round_shift64(m[i][k] * scaled[k], 20);
            }
            rest = t3r_clamp64(rest, -VALUE_MOST, VALUE_MOST);
            m[i][j] = t3r_clamp64(t3r_round_div64(rest * (1 << 20), m[j][j]), -FACTOR_MOST, FACTOR_MOST);
        }
    }
}

void t3r_align_solve(const int64_t a[T3R_ALIGN_PRODUCTS], const int64_t b_q4[N], int32_t x_q30[N])
{
    int64_t m[N][N], value[N], largest = 0;
    int32_t shift[N], common = INT32_MAX;
    scale(a, m, shift);
    factor(m);
    for (uint32_t i = 0; i < N; i++) {
        largest = T3R_MAX(largest, t3r_abs64(b_q4[i]));
    }
    if (largest == 0) {
        for (uint32_t i = 0; i < N; i++) {
            x_q30[i] = 0;
        }
        return;
    }
    for (uint32_t i = 0; i < N; i++) {
        const int64_t size = t3r_abs64(b_q4[i]);
        common = size == 0 ? common : T3R_MIN(common, shift_to(size, 29) - shift[i]);
    }
    for (uint32_t i = 0; i < N; i++) { /* L z = b */
        value[i] = t3r_scale64(b_q4[i], shift[i] + common);
        for (uint32_t k = 0; k < i; k++) {
            value[i] -= t3r_round_shift64(m[i][k] * value[k], 20);
        }
        value[i] = t3r_clamp64(value[i], -VALUE_MOST, VALUE_MOST);
    }
    for (uint32_t i = N; i-- > 0;) { /* D L^T y = z, y in Q24 */
        value[i] = t3r_round_div64(value[i] * (1 << 24), m[i][i]);
        for (uint32_t k = i + 1; k < N; k++) {
            value[i] -= t3r_round_shift64(m[k][i] * value[k], 20);
        }
        value[i] = t3r_clamp64(value[i], -VALUE_MOST, VALUE_MOST);
        const int32_t up = shift[i] - common + 30 - 4 - 24;
        const int64_t x = up > 28 ? (value[i] == 0  ? 0
                                     : value[i] > 0 ? INT64_MAX
                                                    : -INT64_MAX)
                                  : t3r_scale64(value[i], up);
        x_q30[i] = (int32_t)t3r_clamp64(x, -T3R_ALIGN_STEP_MOST_Q30, T3R_ALIGN_STEP_MOST_Q30);
    }
}
