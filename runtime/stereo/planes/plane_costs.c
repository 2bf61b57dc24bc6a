/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_costs.h"

#include "core/fixed.h"

/* A residual of SIGMA / 128 of the scene's spread costs 1, at most FARTHEST. */
#define SIGMA 9
#define FARTHEST 4
/* Depth as it is costs 3/2 where pixels are matched, or it would win everywhere, and 0.3 anywhere; far costs 1. */
#define MATCHED 96
#define ANYWHERE 19
#define FAR 64
/* It costs 2 less where planes are not trusted. */
#define LURE 128
/* A spread beyond the nearest pixels, labels cost 3 for each more; in front of everything they cost 2. */
#define NEAR 192
#define NEAR_MOST 1024
#define NOWHERE 128
/* A cell away from the nearest cell on the plane costs 1/80, at most 0.4. */
#define STRAIGHT 5
#define DIAGONAL 7
#define DISTANCE_Q8 41
#define DISTANT 160

/* The pixels of a cell. */
typedef struct square {
    uint32_t left, top, right, bottom; /* right and bottom are beyond it */
} square;

static square square_of(const t3r_plane_labels *labels, uint32_t cell)
{
    const uint32_t left = cell % labels->columns * labels->cell, top = cell / labels->columns * labels->cell;
    return (square){left, top, T3R_MIN(left + labels->cell, labels->view->width),
                    T3R_MIN(top + labels->cell, labels->view->height)};
}

/* Sets the costs of a cell from the distances of its matched pixels to each label; their own depth is at none. */
static void fit(const t3r_plane_labels *labels, uint32_t cell)
{
    const t3r_view *view = labels->view;
    const square at = square_of(labels, cell);
    const int64_t most = labels->spread_q8 * SIGMA * FARTHEST / 128 + 1, within = labels->planes->within_q8 * 3 / 2;
    int64_t sum[T3R_LABELS_MOST] = {0}; /* at most 2^14 pixels, each below 2^38 */
    uint32_t matched = 0, on[T3R_PLANES_MOST] = {0};
    for (uint32_t v = at.top; v < at.bottom; v++) {
        for (uint32_t u = at.left; u < at.right; u++) {
            const size_t i = (size_t)v * view->width + u;
            if (!t3r_label_matched(view, i)) {
                continue;
            }
            const int64_t own = t3r_inverse_depth_q30(view->depth[i]) * 256;
            matched++;
            const int32_t x = (int32_t)u - labels->middle_x, y = (int32_t)v - labels->middle_y;
            for (uint32_t p = 0; p < labels->planes->count; p++) {
                const int64_t off = t3r_abs64(own - t3r_plane_at_q8(&labels->planes->plane[p], x, y));
                sum[p] += T3R_MIN(off, most);
                on[p] += off <= within;
            }
            sum[labels->count - 1] += T3R_MIN(t3r_abs64(own - labels->far_q8), most);
        }
    }
    const uint32_t pixels = (at.right - at.left) * (at.bottom - at.top);
    T3R_BOUND(pixels > 0); /* a square begins within the picture */
    labels->share_q8[cell] = (uint16_t)(256 * matched / pixels);
    for (uint32_t l = 0; l < labels->count; l++) {
        labels->cost[cell * labels->count + l] =
            (uint16_t)t3r_round_div64(sum[l] * (T3R_LABEL_ONE * FARTHEST), most * pixels);
        if (l < labels->planes->count) {
            labels->on[l * labels->columns * labels->rows + cell] = 4 * on[l] > pixels;
        }
    }
}

/* Adds what a label costs wherever it is. */
static void charge(const t3r_plane_labels *labels, uint32_t cell)
{
    const square at = square_of(labels, cell);
    const uint32_t u = T3R_MIN(at.left + labels->cell / 2, labels->view->width - 1);
    const uint32_t v = T3R_MIN(at.top + labels->cell / 2, labels->view->height - 1);
    const int32_t depth = labels->trust_q8 * (MATCHED * labels->share_q8[cell] + 256 * ANYWHERE);
    for (uint32_t l = 0; l < labels->count; l++) {
        const int64_t inverse_q8 = t3r_label_at_q8(labels, l, u, v);
        const int64_t beyond = T3R_MAX(inverse_q8 - labels->high_q8 - labels->spread_q8, 0);
        const bool own = l == t3r_label_depth(labels), far = l > t3r_label_depth(labels);
        int64_t cost = T3R_MIN(t3r_round_div64(beyond * NEAR, labels->spread_q8), (int64_t)NEAR_MOST);
        cost += inverse_q8 < labels->least_q8 ? NOWHERE : 0;
        cost += own ? t3r_round_shift32(depth, 16) : ((256 - labels->trust_q8) * LURE >> 8) + (far ? FAR : 0);
        t3r_label_add(labels, cell, l, cost);
    }
}

static inline void offer(uint16_t *distance, const t3r_plane_labels *labels, uint32_t cell, int32_t dx, int32_t dy,
                         uint32_t step)
{
    T3R_BOUND(labels->columns > 0);
    const int32_t x = (int32_t)(cell % labels->columns) + dx, y = (int32_t)(cell / labels->columns) + dy;
    if (x >= 0 && y >= 0 && x < (int32_t)labels->columns && y < (int32_t)labels->rows) {
        const uint32_t other = distance[(uint32_t)y * labels->columns + (uint32_t)x] + step;
        distance[cell] = (uint16_t)T3R_MIN(distance[cell], other);
    }
}

/* Adds the distance from cells on a plane, by a sweep down and one up. distance: of each cell, work. */
static void keep_near(const t3r_plane_labels *labels, uint32_t plane, uint16_t *distance)
{
    const uint32_t cells = labels->columns * labels->rows;
    for (uint32_t c = 0; c < cells; c++) {
        distance[c] = labels->on[plane * cells + c] != 0 ? 0 : DISTANT;
    }
    for (uint32_t i = 0; i < 2 * cells; i++) {
        const uint32_t cell = i < cells ? i : 2 * cells - 1 - i;
        const int32_t back = i < cells ? -1 : 1;
        offer(distance, labels, cell, back, 0, STRAIGHT);
        offer(distance, labels, cell, 0, back, STRAIGHT);
        offer(distance, labels, cell, back, back, DIAGONAL);
        offer(distance, labels, cell, -back, back, DIAGONAL);
    }
    for (uint32_t c = 0; c < cells; c++) {
        t3r_label_add(labels, c, plane, distance[c] * DISTANCE_Q8 >> 8);
    }
}

void t3r_plane_costs(const t3r_plane_labels *labels)
{
    const uint32_t cells = labels->columns * labels->rows;
    for (uint32_t c = 0; c < cells; c++) {
        fit(labels, c);
        charge(labels, c);
    }
    for (uint32_t p = 0; p < labels->planes->count; p++) {
        keep_near(labels, p, labels->sum);
    }
}
