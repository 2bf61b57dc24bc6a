/* SPDX-License-Identifier: Apache-2.0 */
#include "importance.h"

#include "core/bits.h"
#include "core/fixed.h"

#define HALF 4 /* half the size of the window in which retained points are counted: 9 x 9 pixels */
/* Excess of a window's density over its SuperCluster's, log2, beyond which only the SuperCluster counts; up to half of
 * it only the window counts. Points in a clump have to cover the area around it. */
#define TRUSTED_Q10 1024

void t3r_importance_keys(const t3r_view *views, uint32_t count, const t3r_importance *importance)
{
    for (uint32_t v = 0; v < count; v++) {
        const uint8_t *plane = (const uint8_t *)importance->planes[v];
        for (uint32_t y = 0; y < views[v].height; y++) {
            const uint16_t *row = (const uint16_t *)(const void *)(plane + (size_t)y * importance->stride_bytes);
            uint16_t *keys = views[v].key + (size_t)y * views[v].width;
            for (uint32_t x = 0; x < views[v].width; x++) {
                keys[x] = (uint16_t)(UINT16_MAX - row[x]);
            }
        }
    }
}

/* Returns bits first..first + count - 1 of the mask, count < 32: they lie in one word or two. */
static uint32_t mask_bits(const uint32_t *mask, size_t first, uint32_t count)
{
    uint32_t shift = (uint32_t)(first % 32), bits = mask[first / 32] >> shift;
    if (shift + count > 32) {
        bits |= mask[first / 32 + 1] << (32 - shift); /* shift > 0, as count < 32 */
    }
    return bits & ((1u << count) - 1);
}

/* Returns log2(retained / valid), Q10; both below 2^28. */
static int32_t log_share_q10(uint32_t retained, uint32_t valid)
{
    if (retained >= valid) { /* a restored arena's planes may retain more points than valid, or none */
        return 0;
    }
    if (retained == 0) {
        return T3R_LEAST_DENSITY_Q10;
    }
    int32_t log_q16 = t3r_log2_q16(retained) - t3r_log2_q16(valid);
    return T3R_MAX(t3r_round_shift32(log_q16, 6), T3R_LEAST_DENSITY_Q10);
}

void t3r_count_shares(const t3r_view *views, uint32_t count, t3r_cluster *clusters, uint32_t cluster_count)
{
    uint32_t retained[T3R_MAX_CLUSTERS] = {0};
    for (uint32_t v = 0; v < count; v++) {
        size_t pixels = (size_t)views[v].width * views[v].height;
        for (size_t i = 0; i < pixels; i++) {
            if (t3r_retained(&views[v], i)) { /* only points are retained, and points have labels */
                retained[t3r_label_of(&views[v], i)]++;
            }
        }
    }
    for (uint32_t k = 0; k < cluster_count; k++) {
        clusters[k].density_q10 = log_share_q10(retained[k], clusters[k].points);
    }
}

/* Returns the share in the window around a pixel, clipped to the picture: at most 9 rows of 9 bytes and two words. */
static int32_t window_share_q10(const t3r_view *view, uint32_t x, uint32_t y)
{
    uint32_t x0 = x > HALF ? x - HALF : 0, x1 = T3R_MIN(x + HALF, view->width - 1);
    uint32_t y0 = y > HALF ? y - HALF : 0, y1 = T3R_MIN(y + HALF, view->height - 1);
    uint32_t retained = 0, valid = 0;
    for (uint32_t row = y0; row <= y1; row++) {
        size_t first = (size_t)row * view->width + x0;
        retained += t3r_ones(mask_bits(view->mask, first, x1 - x0 + 1));
        for (uint32_t i = 0; i <= x1 - x0; i++) {
            valid += t3r_has_depth(view->validity[first + i]);
        }
    }
    return log_share_q10(retained, valid);
}

int32_t t3r_log_share_q10(const t3r_view *view, size_t pixel, const t3r_cluster *clusters)
{
    int32_t here = window_share_q10(view, (uint32_t)(pixel % view->width), (uint32_t)(pixel / view->width));
    int32_t more = here - clusters[t3r_label_of(view, pixel)].density_q10; /* excess over its SuperCluster */
    return here - t3r_clamp32(2 * more - TRUSTED_Q10, 0, T3R_MAX(more, 0));
}
