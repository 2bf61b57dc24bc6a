/* SPDX-License-Identifier: Apache-2.0 */
/* Rows of the wavelet: each entry against its formula, sample by sample, in wide integers that then wrap. */
#include "checks.h"
#include "guarded.h"

enum { MOST = 700 };

static int16_t *random_row(uint64_t *seed, size_t count)
{
    int16_t *row = guarded_take(count * 2, 2);
    for (size_t i = 0; i < count; i++) {
        row[i] = (int16_t)any_value(seed, -32768, 32767);
    }
    return row;
}

static int64_t rounded(int64_t x, int bits)
{
    return (int64_t)floor((double)x / (double)(1 << bits) + 0.5);
}

const char *check_luma_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST);
    uint8_t *c[3];
    for (int i = 0; i < 3; i++) {
        c[i] = guarded_take(count, 1);
        for (uint32_t x = 0; x < count; x++) {
            c[i][x] = (uint8_t)any_value(seed, 0, 255);
        }
    }
    int16_t *row = guarded_take(count * 2, 2);
    kernels->luma_row(row, c[0], c[1], c[2], count);
    for (uint32_t x = 0; x < count; x++) {
        if (row[x] != ((77 * c[0][x] + 150 * c[1][x] + 29 * c[2][x] + 128) / 256 - 128) * 16) {
            return "a sample differs";
        }
    }
    return NULL;
}

const char *check_split_row(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST);
    const int16_t *row = random_row(seed, count);
    int16_t *even = guarded_take((count + 1) / 2 * 2, 2), *odd = guarded_take(count / 2 * 2, 2);
    kernels->split_row(even, odd, row, count);
    for (uint32_t x = 0; x < count; x++) {
        if (row[x] != (x % 2 == 0 ? even : odd)[x / 2]) {
            return "a sample differs";
        }
    }
    return NULL;
}

/* Checks that `to` changes by one row, or by two that may overlap; MADE is the expected sample, a function of to, a
 * and b. */
#define LIFT(NAME, CALL, MADE)                                                                                         \
    const char *check_##NAME(const t3r_kernels *kernels, uint64_t *seed)                                               \
    {                                                                                                                  \
        const uint32_t count = any_length(seed, MOST);                                                                 \
        int16_t *to = random_row(seed, count), before[MOST];                                                           \
        const int16_t *a = random_row(seed, count + 1), *b = unit_random(seed) % 2 ? a + 1 : a;                        \
        memcpy(before, to, count * sizeof *to);                                                                        \
        kernels->CALL;                                                                                                 \
        for (uint32_t i = 0; i < count; i++) {                                                                         \
            const int64_t t = before[i], x = a[i], y = b[i];                                                           \
            (void)y;                                                                                                   \
            if (to[i] != (int16_t)(uint16_t)(MADE)) {                                                                  \
                return "a sample differs";                                                                             \
            }                                                                                                          \
        }                                                                                                              \
        return NULL;                                                                                                   \
    }
LIFT(db2_predict, db2_predict(to, a, count), t - 2 * x + rounded(x * T3R_DB2_PREDICT_Q15, 15))
LIFT(subtract_row, subtract_row(to, a, count), t - x)
LIFT(haar_update, haar_update(to, a, count), t + rounded(x, 1))
LIFT(cdf53_predict, cdf53_predict(to, a, b, count), t - rounded(x + y, 1))
LIFT(cdf53_update, cdf53_update(to, a, b, count), t + rounded(x + y, 2))

static int16_t updated(int64_t low, int64_t high, int64_t next)
{
    return (int16_t)(uint16_t)(low + rounded(high * T3R_DB2_UPDATE_Q15, 15) -
                               rounded(next * T3R_DB2_UPDATE_NEXT_Q15, 15));
}

const char *check_db2_lift(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST);
    int16_t *low = random_row(seed, count), *high = random_row(seed, count), before[2][MOST], next_before[MOST];
    const int16_t *previous = random_row(seed, count), *other = random_row(seed, count);
    const int16_t *next = unit_random(seed) % 4 == 0 ? high : other;
    memcpy(before[0], low, count * sizeof *low);
    memcpy(before[1], high, count * sizeof *high);
    memcpy(next_before, next, count * sizeof *next);
    kernels->db2_lift(low, high, next, previous, count);
    for (uint32_t i = 0; i < count; i++) {
        if (low[i] != updated(before[0][i], before[1][i], next_before[i]) ||
            high[i] != (int16_t)(uint16_t)(before[1][i] + previous[i])) {
            return "a sample differs";
        }
    }
    return NULL;
}

const char *check_db2_split(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST / 2);
    const int16_t *row = random_row(seed, 2 * count);
    int16_t *low = guarded_take(count * 2, 2), *high = guarded_take(count * 2, 2);
    kernels->db2_split(low, high, row, count);
    for (uint32_t i = 0; i < count; i++) {
        const int64_t first = row[2 * i];
        const int64_t made = row[2 * i + 1] - 2 * first + rounded(first * T3R_DB2_PREDICT_Q15, 15);
        if (low[i] != first || high[i] != (int16_t)(uint16_t)made) {
            return "a sample differs";
        }
    }
    return NULL;
}

/* Both halves are in one row. */
const char *check_db2_join(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST / 2), between = (uint32_t)unit_between(seed, 0, 2);
    const int16_t *low = random_row(seed, count), *high = random_row(seed, count + 1);
    int16_t *lows = random_row(seed, count + 1 + between + count), *highs = lows + count + 1 + between;
    const int16_t first = lows[0];
    kernels->db2_join(lows, highs, low, high, count);
    for (uint32_t i = 0; i < count; i++) {
        if (lows[i + 1] != updated(low[i], high[i], high[i + 1]) ||
            highs[i] != (int16_t)(uint16_t)(high[i] + lows[i])) {
            return "a sample differs";
        }
    }
    return lows[0] == first ? NULL : "the first sample differs";
}

/* Makes coefficients within the bounds of wavelet_texture.c. */
static int16_t *coefficients(uint64_t *seed, size_t count, int64_t most)
{
    int16_t *row = guarded_take(count * 2, 2);
    for (size_t i = 0; i < count; i++) {
        row[i] = (int16_t)any_value(seed, -most, most);
    }
    return row;
}

const char *check_texture_finest(const t3r_kernels *kernels, uint64_t *seed)
{
    const uint32_t count = any_length(seed, MOST);
    const uint16_t gain = unit_random(seed) % 2 ? 17560 : 32768;
    const int16_t *h = coefficients(seed, count, 10430), *v = coefficients(seed, count, 10430);
    const int16_t *d = coefficients(seed, count, gain == 17560 ? 32640 : 16384);
    uint16_t *texture = guarded_take(count * 2, 2);
    kernels->texture_finest(texture, h, v, d, gain, count);
    for (uint32_t i = 0; i < count; i++) {
        if (texture[i] != abs(h[i]) + abs(v[i]) + rounded((int64_t)abs(d[i]) * gain, 16)) {
            return "a sample differs";
        }
    }
    return NULL;
}

const char *check_texture_coarse(const t3r_kernels *kernels, uint64_t *seed)
{
    static const uint32_t gains[][2] = {{955, 256},     {3566, 955}, {13307, 3566},
                                        {49662, 13307}, {512, 256},  {4096, 2048}};
    const uint32_t count = any_length(seed, MOST), *gain = gains[unit_random(seed) % 6];
    const int16_t *h = coefficients(seed, count, 10430), *v = coefficients(seed, count, 10430);
    const int16_t *d = coefficients(seed, count, 23620);
    uint16_t *texture = guarded_take(count * 2, 2);
    kernels->texture_coarse(texture, h, v, d, gain[0], gain[1], count);
    for (uint32_t i = 0; i < count; i++) {
        const int64_t sum = (int64_t)gain[0] * (abs(h[i]) + abs(v[i])) + (int64_t)gain[1] * abs(d[i]);
        const int64_t want = rounded(sum, 8);
        if (texture[i] != (want > 65535 ? 65535 : want)) {
            return "a sample differs";
        }
    }
    return NULL;
}

/* Checks with or without adding to the previous contents. */
static const char *check_spread(const t3r_kernels *kernels, uint64_t *seed, bool add)
{
    const uint32_t count = any_length(seed, MOST);
    uint16_t *fine = (uint16_t *)random_row(seed, count), before[MOST];
    const uint16_t *coarse = (const uint16_t *)random_row(seed, (count + 1) / 2);
    memcpy(before, fine, count * sizeof *fine);
    if (add) {
        kernels->texture_add(fine, coarse, count);
    } else {
        kernels->texture_spread(fine, coarse, count);
    }
    for (uint32_t i = 0; i < count; i++) {
        const uint32_t sum = (add ? before[i] : 0u) + coarse[i / 2];
        if (fine[i] != (sum > 65535 ? 65535 : sum)) {
            return "a sample differs";
        }
    }
    return NULL;
}

const char *check_texture_add(const t3r_kernels *kernels, uint64_t *seed)
{
    return check_spread(kernels, seed, true);
}

const char *check_texture_spread(const t3r_kernels *kernels, uint64_t *seed)
{
    return check_spread(kernels, seed, false);
}
