/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_labels.h"

#include "core/fixed.h"
#include "core/memory.h"

/* 1/TAIL of the matched pixels are left out at either end of the scene's depth. */
#define TAIL 33
/* Planes are trusted where their thickness is below THIN / 100 of the spread of depth, not at all above THICK / 100. */
#define THIN 12
#define THICK 16
/* Labels are used up to the nearest pixels and two spreads beyond. */
#define BEYOND 2

/* Returns the bin below which 1/TAIL of the pixels lie, from the near or the far end. */
static uint32_t end_of(const uint32_t *histogram, uint32_t matched, bool near)
{
    uint32_t seen = 0, bin = 0;
    for (; bin + 1 < T3R_LABEL_BINS; bin++) {
        seen += histogram[near ? T3R_LABEL_BINS - 1 - bin : bin];
        if (TAIL * seen > matched) {
            break;
        }
    }
    return near ? T3R_LABEL_BINS - 1 - bin : bin;
}

/* Measures the distances of the matched pixels. */
static void measure(t3r_plane_labels *labels)
{
    const t3r_view *view = labels->view;
    const size_t pixels = T3R_PIXELS_(view->width, view->height);
    int64_t sum = 0;
    uint32_t matched = 0; /* at least one, because there is a plane */
    for (size_t i = 0; i < pixels; i++) {
        if (t3r_label_matched(view, i)) {
            sum += t3r_inverse_depth_q30(view->depth[i]);
            matched++;
        }
    }
    const int64_t bin_q8 = T3R_MAX(t3r_round_div64(sum * 256, (int64_t)matched * T3R_LABEL_MEAN), 1);
    memset(labels->histogram, 0, T3R_LABEL_BINS * sizeof *labels->histogram);
    for (size_t i = 0; i < pixels; i++) {
        if (t3r_label_matched(view, i)) {
            const int64_t bin = t3r_inverse_depth_q30(view->depth[i]) * 256 / bin_q8;
            labels->histogram[T3R_MIN(bin, (int64_t)T3R_LABEL_BINS - 1)]++;
        }
    }
    const int64_t low = end_of(labels->histogram, matched, false), high = end_of(labels->histogram, matched, true);
    labels->least_q8 = bin_q8;
    labels->high_q8 = high * bin_q8 + bin_q8 / 2;
    labels->spread_q8 = T3R_MAX(high - low, 1) * bin_q8;
    labels->most_q8 = labels->high_q8 + BEYOND * labels->spread_q8;
    labels->far_q8 = T3R_MAX((2 * low + 1) * bin_q8 / 8, bin_q8);
}

void t3r_plane_labels_begin(t3r_plane_labels *labels, const t3r_view *view, const t3r_planes *planes, t3r_cut *cut)
{
    const uint32_t longer = T3R_MAX(view->width, view->height);
    *labels = (t3r_plane_labels){.view = view,
                                 .planes = planes,
                                 .middle_x = (int32_t)view->width / 2,
                                 .middle_y = (int32_t)view->height / 2,
                                 .cell = (longer + T3R_LABEL_CELLS - 1) / T3R_LABEL_CELLS,
                                 .count = planes->count + 2};
    labels->columns = (view->width + labels->cell - 1) / labels->cell;
    labels->rows = (view->height + labels->cell - 1) / labels->cell;
    labels->cost = t3r_take(cut, (size_t)T3R_LABEL_GRID * T3R_LABELS_MOST * sizeof *labels->cost);
    labels->sum = t3r_take(cut, (size_t)T3R_LABEL_GRID * T3R_LABELS_MOST * sizeof *labels->sum);
    labels->share_q8 = t3r_take(cut, (size_t)T3R_LABEL_GRID * sizeof *labels->share_q8);
    labels->on = t3r_take(cut, (size_t)T3R_LABEL_GRID * T3R_PLANES_MOST);
    labels->histogram = t3r_take(cut, (size_t)T3R_LABEL_BINS * sizeof *labels->histogram);
    measure(labels);
    const int64_t thick = 100 * planes->within_q8;
    labels->trust_q8 = (int32_t)t3r_clamp64(
        t3r_round_div64(256 * (THICK * labels->spread_q8 - thick), (THICK - THIN) * labels->spread_q8), 0, 256);
}
