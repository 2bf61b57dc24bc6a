/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/nearest.h"

#include <stdbool.h>

static int32_t score_of(const t3r_centres *centres, const int16_t *p, uint32_t k)
{
    int32_t dot = 0;
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        dot += p[d] * centres->feature_q11[d][k];
    }
    return centres->half_norm[k] - dot;
}

/* Returns |c_a - c_b|^2: at most 6 x 30000^2 < 2^33. */
static int64_t square_between(const t3r_centres *centres, uint32_t a, uint32_t b)
{
    int64_t sum = 0;
    for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
        int32_t e = centres->feature_q11[d][a] - centres->feature_q11[d][b];
        sum += (int64_t)e * e;
    }
    return sum;
}

void t3r_nearest_begin_c(const t3r_centres *centres, uint32_t first, uint32_t end, const t3r_neighbours *neighbours)
{
    for (uint32_t k = first; k < end; k++) {
        int64_t square[T3R_NEIGHBOURS];
        uint16_t *list = neighbours->index[k];
        uint32_t known = 0;
        for (uint32_t other = 0; other < centres->count; other++) {
            if (other == k) {
                continue;
            }
            int64_t s = square_between(centres, k, other);
            if (known == T3R_NEIGHBOURS && s >= square[known - 1]) {
                continue;
            }
            uint32_t place = known < T3R_NEIGHBOURS ? known++ : known - 1;
            for (; place > 0 && square[place - 1] > s; place--) {
                square[place] = square[place - 1];
                list[place] = list[place - 1];
            }
            square[place] = s;
            list[place] = (uint16_t)other;
        }
    }
}

/* Finds the nearest of all centres in three loops without branches: scores, their least, and the first that has it. */
static uint16_t nearest_of_all(const t3r_centres *centres, const int16_t *p)
{
    int32_t score[T3R_MAX_CLUSTERS];
    int16_t *const *c = centres->feature_q11;
    const int16_t p0 = p[0], p1 = p[1], p2 = p[2], p3 = p[3], p4 = p[4], p5 = p[5];
    for (uint32_t k = 0; k < centres->count; k++) {
        score[k] = centres->half_norm[k] -
                   (p0 * c[0][k] + p1 * c[1][k] + p2 * c[2][k] + p3 * c[3][k] + p4 * c[4][k] + p5 * c[5][k]);
    }
    int32_t least = INT32_MAX;
    for (uint32_t k = 0; k < centres->count; k++) {
        least = score[k] < least ? score[k] : least;
    }
    uint32_t first = 0;
    /* Ends before count: the least is one of them. NOLINTNEXTLINE(clang-analyzer-core.UndefinedBinaryOperatorResult) */
    while (score[first] != least) {
        first++;
    }
    return (uint16_t)first;
}

/* Searches the neighbours of centre g as long as one of them can still be nearer. With d = |p - c_g|, a centre c with
 * |c - c_g|^2 > 4 d^2 + 4 has |p - c|^2 > d^2 + 1, so its score, even rounded down, is not below g's. Returns false if
 * the list ended before that. */
static bool nearest_near(const t3r_centres *centres, const t3r_neighbours *neighbours, const int16_t *p, int32_t norm,
                         uint32_t g, uint16_t *nearest)
{
    uint32_t listed = centres->count - 1 < T3R_NEIGHBOURS ? centres->count - 1 : T3R_NEIGHBOURS;
    int32_t least = score_of(centres, p, g);
    /* d^2 = |p|^2 + 2 score, and 1 for the half that half_norm may have lost */
    int64_t bound = 4 * (norm + 2 * (int64_t)least + 1) + 4;
    uint32_t best = g;
    for (uint32_t i = 0; i < listed; i++) {
        uint32_t k = neighbours->index[g][i];
        if (square_between(centres, g, k) > bound) {
            *nearest = (uint16_t)best;
            return true;
        }
        int32_t score = score_of(centres, p, k);
        if (score < least || (score == least && k < best)) {
            least = score;
            best = k;
        }
    }
    *nearest = (uint16_t)best;
    return listed == centres->count - 1;
}

void t3r_nearest_c(const t3r_centres *centres, const t3r_neighbours *neighbours, uint32_t points,
                   const int16_t (*feature_q11)[T3R_DIMENSIONS], uint16_t guess, uint16_t *nearest)
{
    for (uint32_t point = 0; point < points; point++) {
        const int16_t *p = feature_q11[point];
        int32_t norm = 0; /* at most 6 x 15000^2 < 2^31 */
        for (uint32_t d = 0; d < T3R_DIMENSIONS; d++) {
            norm += p[d] * p[d];
        }
        if (!nearest_near(centres, neighbours, p, norm, guess, &nearest[point])) {
            nearest[point] = nearest_of_all(centres, p);
        }
        guess = nearest[point];
    }
}
