/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_mix.h"

#include "core/fixed.h"

/* A label's weight falls to one half with a path cost of 0.35: exp(-2 cost). Sums of four paths have 10 more
 * fraction bits (Q18) than such a cost has in units of 2^-8. */
#define HALVINGS_Q5 92
#define WEIGHT_MOST 8 /* halvings after which a label has no weight */
/* After a path of NEAR, six straight steps, a filled pixel's own depth counts as much as the mix. Lengths are at most
 * 65,535. */
#define NEAR 30u

/* Two neighbouring cells along a side and the second one's weight. */
typedef struct between {
    uint32_t first, second;
    uint32_t weight_q8;
} between;

static between between_of(uint32_t pixel, uint32_t cell, uint32_t cells)
{
    const uint32_t twice = 2 * pixel + 1; /* in half pixels; a cell's middle is `cell` from its side */
    const uint32_t at = T3R_MIN(twice > cell ? twice - cell : 0, 2 * cell * (cells - 1));
    const uint32_t first = at / (2 * cell);
    return (between){first, T3R_MIN(first + 1, cells - 1), at % (2 * cell) * 128 / cell};
}

/* Computes sums of paths at a pixel, Q8, by label; returns the least. Labels that are nowhere have UINT32_MAX. */
static uint32_t sums_at(const t3r_plane_labels *labels, const between *x, const between *y, uint32_t count,
                        const int64_t *inverse_q8, uint32_t *sum_q8)
{
    const uint16_t *row[2] = {labels->sum + (size_t)y->first * labels->columns * count,
                              labels->sum + (size_t)y->second * labels->columns * count};
    uint32_t least = UINT32_MAX;
    for (uint32_t l = 0; l < count; l++) {
        uint32_t ends[2];
        for (int i = 0; i < 2; i++) {
            ends[i] = row[i][x->first * count + l] * (256 - x->weight_q8) +
                      row[i][x->second * count + l] * x->weight_q8; /* below 2^14 x 2^8 */
        }
        const uint32_t sum = (ends[0] * (256 - y->weight_q8) + ends[1] * y->weight_q8) >> 8;
        sum_q8[l] = inverse_q8[l] < labels->least_q8 ? UINT32_MAX : sum;
        least = T3R_MIN(least, sum_q8[l]);
    }
    return least;
}

/* Returns the mix of labels by their weights, Q30 + 8. */
static int64_t mix(uint32_t count, const int64_t *inverse_q8, const uint32_t *sum_q8, uint32_t least)
{
    int64_t weights = 0, sum = 0; /* at most 10 x 2^16; one over depth below 2^36 */
    for (uint32_t l = 0; l < count; l++) {
        const int64_t halvings_q16 = ((int64_t)sum_q8[l] - least) * HALVINGS_Q5 >> 5;
        if (halvings_q16 < WEIGHT_MOST << 16) {
            const uint32_t weight = t3r_exp2_q16((int32_t)-halvings_q16);
            weights += weight;
            sum += weight * inverse_q8[l];
        }
    }
    return t3r_round_div64(sum, weights);
}

/* Gives a filled pixel the mix of labels, and of its own depth the more, the shorter the path to its source is. */
static void mix_pixel(const t3r_plane_labels *labels, uint32_t u, uint32_t v, const between *x, const between *y,
                      uint32_t length)
{
    const t3r_view *view = labels->view;
    const size_t i = (size_t)v * view->width + u;
    const uint32_t count = labels->count;
    int64_t inverse_q8[T3R_LABELS_MOST];
    uint32_t sum_q8[T3R_LABELS_MOST];
    for (uint32_t l = 0; l < count; l++) {
        inverse_q8[l] = T3R_MIN(t3r_label_at_q8(labels, l, u, v), labels->most_q8);
    }
    const uint32_t least = sums_at(labels, x, y, count, inverse_q8, sum_q8);
    const int64_t mixed_q8 = mix(count, inverse_q8, sum_q8, least), own_q8 = inverse_q8[t3r_label_depth(labels)];
    const uint32_t own = view->depth[i] != 0 ? 256 * NEAR * NEAR / (NEAR * NEAR + length * length) : 0; /* Q8 */
    const int64_t there_q8 = (own_q8 * own + mixed_q8 * (256 - own)) >> 8; /* of values below 2^39 */
    view->depth[i] = (uint16_t)t3r_clamp64(t3r_round_div64(INT64_C(1) << 38, there_q8), 1, UINT16_MAX);
    view->match_confidence[i] = T3R_STEREO_FILLED;
}

void t3r_plane_mix(const t3r_plane_labels *labels, const uint16_t *length)
{
    const t3r_view *view = labels->view;
    for (uint32_t v = 0; v < view->height; v++) {
        const between y = between_of(v, labels->cell, labels->rows);
        for (uint32_t u = 0; u < view->width; u++) {
            const between x = between_of(u, labels->cell, labels->columns);
            const size_t i = (size_t)v * view->width + u;
            const bool shows = (view->colour[0][i] | view->colour[1][i] | view->colour[2][i]) != 0;
            if (shows && !t3r_label_matched(view, i)) {
                mix_pixel(labels, u, v, &x, &y, length[i]);
            }
        }
    }
}
