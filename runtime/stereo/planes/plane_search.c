/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_search.h"

#include "core/cut.h"
#include "core/memory.h"
#include "stereo/stereo.h"

/* A hypothesis needs matches at 1/LEAST_FILLED of its window's pixels. */
#define LEAST_FILLED 4
/* A plane needs 1/LEAST_SHARE of all samples. */
#define LEAST_SHARE 100
/* Pixels lie on a plane within DEVIATIONS times the median cell's mean deviation from its own plane, */
#define DEVIATIONS 6
/* and at least within 1/LEAST_WITHIN of the mean: steps of depth are coarse at short range. */
#define LEAST_WITHIN 128
/* Rounds of least squares over the pixels on a plane, because the first fit uses only a few cells. */
#define FITS 3
/* 1/SPREAD of a cell's square pixels is added to the spread of places. */
#define SPREAD 128
/* Samples that a fit needs */
#define LEAST_SAMPLES 8

typedef struct search {
    const t3r_view *view;
    int32_t middle_x, middle_y;
    uint32_t cell, columns, rows; /* side of a cell; their numbers */
    int32_t spread_q4;
    uint32_t step, samples; /* distance of the samples; their number, with unmatched ones */
    uint32_t hypotheses;
    t3r_surface_sums *sums;
    t3r_plane_hypothesis *hypothesis;
    t3r_plane_square *square;
} search;

/* Returns one over the depth of a matched pixel, 0 for others. */
static int32_t matched_inverse(const t3r_view *view, size_t i)
{
    const bool matched = view->depth[i] != 0 && view->match_confidence[i] >= T3R_STEREO_LEAST;
    return matched ? (int32_t)t3r_inverse_depth_q30(view->depth[i]) : 0;
}

static void add(t3r_surface_sums *s, int32_t x, int32_t y, int64_t i)
{
    /* at most 2^19.2 pixels, |x| at most 2^11, i at most 2^24 */
    s->n++;
    s->x += x;
    s->y += y;
    s->i += i;
    s->xx += x * x;
    s->xy += x * y;
    s->yy += y * y;
    s->xi += x * i;
    s->yi += y * i;
}

static void merge(t3r_surface_sums *to, const t3r_surface_sums *s)
{
    to->n += s->n;
    to->x += s->x;
    to->y += s->y;
    to->i += s->i;
    to->xx += s->xx;
    to->xy += s->xy;
    to->yy += s->yy;
    to->xi += s->xi;
    to->yi += s->yi;
}

/* Returns the plane through the sums' mean with their slopes; n > 0. */
static t3r_plane plane_through(const t3r_surface_sums *s, int32_t spread_q4)
{
    const t3r_surface_slope slope = t3r_surface_slope_of(s, spread_q4);
    const int64_t mean_q8 = t3r_round_div64(s->i * 256, s->n);
    /* slopes below 2^31, sums of places below 2^31 */
    const int64_t back_q8 = t3r_round_div64(s->x * slope.x_q8, s->n) + t3r_round_div64(s->y * slope.y_q8, s->n);
    return (t3r_plane){mean_q8 - back_q8, slope.x_q8, slope.y_q8};
}

static void sum_cells(const search *s)
{
    const t3r_view *view = s->view;
    memset(s->sums, 0, (size_t)s->columns * s->rows * sizeof *s->sums);
    for (uint32_t v = 0; v < view->height; v++) {
        for (uint32_t u = 0; u < view->width; u++) {
            const int32_t inverse = matched_inverse(view, (size_t)v * view->width + u);
            if (inverse != 0) {
                add(&s->sums[v / s->cell * s->columns + u / s->cell], (int32_t)u - s->middle_x,
                    (int32_t)v - s->middle_y, inverse);
            }
        }
    }
}

static void clear(t3r_plane_square *square)
{
    square->least = INT32_MAX;
    square->most = 0;
    square->count = 0;
}

static void keep(t3r_plane_square *square, t3r_plane_sample sample)
{
    square->sample[square->count++] = sample;
    square->least = T3R_MIN(square->least, sample.inverse);
    square->most = T3R_MAX(square->most, sample.inverse);
}

/* Takes the samples of a square, whose first one is at a pixel. */
static void take_square(search *s, uint32_t left, uint32_t top, t3r_plane_square *square)
{
    const t3r_view *view = s->view;
    square->x = (int32_t)left - s->middle_x;
    square->y = (int32_t)top - s->middle_y;
    clear(square);
    for (uint32_t k = 0; k < T3R_PLANE_SQUARE * T3R_PLANE_SQUARE; k++) {
        const uint32_t x = k % T3R_PLANE_SQUARE * s->step, y = k / T3R_PLANE_SQUARE * s->step;
        if (left + x >= view->width || top + y >= view->height) {
            continue;
        }
        const int32_t inverse = matched_inverse(view, (size_t)(top + y) * view->width + left + x);
        s->samples++;
        if (inverse != 0) {
            keep(square,
                 (t3r_plane_sample){(int16_t)(square->x + (int32_t)x), (int16_t)(square->y + (int32_t)y), inverse});
        }
    }
}

/* Samples the pixels of a grid. */
static void take_samples(search *s)
{
    const uint32_t across = T3R_PLANE_SAMPLES / T3R_PLANE_SQUARE;
    s->step = (T3R_MAX(s->view->width, s->view->height) + T3R_PLANE_SAMPLES - 1) / T3R_PLANE_SAMPLES;
    for (uint32_t q = 0; q < T3R_PLANE_SQUARES; q++) {
        take_square(s, q % across * T3R_PLANE_SQUARE * s->step + s->step / 2,
                    q / across * T3R_PLANE_SQUARE * s->step + s->step / 2, &s->square[q]);
    }
}

/* Returns the mean distance of a cell's `count` matched pixels from its plane, Q30 + 8. */
static uint32_t deviation_q8(const search *s, uint32_t column, uint32_t row, int64_t count, const t3r_plane *plane)
{
    const t3r_view *view = s->view;
    int64_t sum = 0; /* at most 2^16 pixels, each counted as at most 2^32 */
    for (uint32_t v = row * s->cell; v < view->height && v < (row + 1) * s->cell; v++) {
        for (uint32_t u = column * s->cell; u < view->width && u < (column + 1) * s->cell; u++) {
            const int64_t inverse = matched_inverse(view, (size_t)v * view->width + u);
            if (inverse != 0) {
                const int64_t off =
                    inverse * 256 - t3r_plane_at_q8(plane, (int32_t)u - s->middle_x, (int32_t)v - s->middle_y);
                sum += T3R_MIN(t3r_abs64(off), (int64_t)T3R_INVERSE_MOST * 256);
            }
        }
    }
    return (uint32_t)T3R_MIN(t3r_round_div64(sum, count), (int64_t)UINT32_MAX);
}

static void insert(uint32_t *rising, uint32_t count, uint32_t value)
{
    uint32_t place = count;
    for (; place > 0 && rising[place - 1] > value; place--) {
        rising[place] = rising[place - 1];
    }
    rising[place] = value;
}

/* Makes hypotheses of all windows with enough matches; returns the median cell's deviation. */
static int64_t suppose(search *s, uint32_t *deviations)
{
    uint32_t cells = 0;
    s->hypotheses = 0;
    for (uint32_t side = 1; side <= 3; side++) {
        for (uint32_t row = 0; row + side <= s->rows; row++) {
            for (uint32_t column = 0; column + side <= s->columns; column++) {
                t3r_surface_sums sums = {0};
                for (uint32_t k = 0; k < side * side; k++) {
                    merge(&sums, &s->sums[(row + k / side) * s->columns + column + k % side]);
                }
                if (LEAST_FILLED * sums.n < (int64_t)(side * side) * s->cell * s->cell) {
                    continue;
                }
                const t3r_plane plane = plane_through(&sums, s->spread_q4);
                s->hypothesis[s->hypotheses++] = (t3r_plane_hypothesis){plane, 0, 0};
                if (side == 1) {
                    insert(deviations, cells++, deviation_q8(s, column, row, sums.n, &plane));
                }
            }
        }
    }
    return cells > 0 ? deviations[cells / 2] : 0;
}

/* Returns the distance up to which pixels lie on a plane, Q30 + 8. */
static int64_t width_of(const search *s, int64_t deviation)
{
    int64_t n = 0, sum = 0;
    for (uint32_t k = 0; k < s->columns * s->rows; k++) {
        n += s->sums[k].n;
        sum += s->sums[k].i;
    }
    return T3R_MAX(DEVIATIONS * deviation, n > 0 ? t3r_round_div64(sum, n) * 256 / LEAST_WITHIN : 0);
}

static bool is_on(const t3r_plane *plane, const t3r_plane_sample *at, int64_t within_q8)
{
    const int64_t off = (int64_t)at->inverse * 256 - t3r_plane_at_q8(plane, at->x, at->y);
    return (uint64_t)(off + within_q8) <= 2 * (uint64_t)within_q8;
}

static uint32_t count_on(const search *s, const t3r_plane *plane, int64_t within_q8)
{
    /* bounds of one over depth in a square, from the plane at the first sample */
    const int64_t last = (T3R_PLANE_SQUARE - 1) * (int64_t)s->step, x = last * plane->x_q8, y = last * plane->y_q8;
    const int64_t down = T3R_MIN(x, 0) + T3R_MIN(y, 0) - within_q8, up = T3R_MAX(x, 0) + T3R_MAX(y, 0) + within_q8;
    uint32_t count = 0;
    for (const t3r_plane_square *q = s->square; q < s->square + T3R_PLANE_SQUARES; q++) {
        const int64_t first = t3r_plane_at_q8(plane, q->x, q->y);
        if ((int64_t)q->least * 256 - first > up || (int64_t)q->most * 256 - first < down) {
            continue;
        }
        for (uint32_t k = 0; k < q->count; k++) {
            count += is_on(plane, &q->sample[k], within_q8);
        }
    }
    return count;
}

/* Returns the first hypothesis with the most samples that are left. Counts fall as samples are taken away, so an older
 * one is a bound, and only those above the best are counted again. */
static const t3r_plane_hypothesis *best_of(const search *s, const t3r_planes *found)
{
    for (;;) {
        t3r_plane_hypothesis *best = s->hypothesis;
        for (uint32_t h = 1; h < s->hypotheses; h++) {
            best = s->hypothesis[h].samples > best->samples ? &s->hypothesis[h] : best;
        }
        if (best->planes == found->count) {
            return best;
        }
        best->samples = count_on(s, &best->plane, found->within_q8);
        best->planes = found->count;
    }
}

static t3r_plane refined(const search *s, t3r_plane plane, int64_t within_q8)
{
    for (uint32_t fit = 0; fit < FITS; fit++) {
        t3r_surface_sums sums = {0};
        for (const t3r_plane_square *q = s->square; q < s->square + T3R_PLANE_SQUARES; q++) {
            for (uint32_t k = 0; k < q->count; k++) {
                const t3r_plane_sample *at = &q->sample[k];
                if (is_on(&plane, at, within_q8)) {
                    add(&sums, at->x, at->y, at->inverse);
                }
            }
        }
        plane = sums.n < LEAST_SAMPLES ? plane : plane_through(&sums, 1);
    }
    return plane;
}

/* Removes the samples on a plane, so that each is used once. */
static void take_away(search *s, const t3r_plane *plane, int64_t within_q8)
{
    for (t3r_plane_square *q = s->square; q < s->square + T3R_PLANE_SQUARES; q++) {
        const uint32_t count = q->count;
        clear(q);
        for (uint32_t k = 0; k < count; k++) {
            if (!is_on(plane, &q->sample[k], within_q8)) {
                keep(q, q->sample[k]);
            }
        }
    }
}

void t3r_search_planes(const t3r_view *view, void *work, t3r_planes *found)
{
    const size_t cells = (size_t)T3R_PLANE_CELLS * T3R_PLANE_CELLS;
    t3r_cut cut = t3r_cut_of(work, T3R_PLANE_SEARCH_BYTES);
    search s = {.view = view, .middle_x = (int32_t)view->width / 2, .middle_y = (int32_t)view->height / 2};
    s.cell = (T3R_MAX(view->width, view->height) + T3R_PLANE_CELLS - 1) / T3R_PLANE_CELLS;
    s.spread_q4 = (int32_t)T3R_MAX(16 * s.cell * s.cell / SPREAD, 1);
    s.columns = (view->width + s.cell - 1) / s.cell;
    s.rows = (view->height + s.cell - 1) / s.cell;
    s.sums = t3r_take(&cut, cells * sizeof *s.sums);
    s.hypothesis = t3r_take(&cut, T3R_PLANE_HYPOTHESES * sizeof *s.hypothesis);
    s.square = t3r_take(&cut, T3R_PLANE_SQUARES * sizeof *s.square);
    uint32_t *deviations = t3r_take(&cut, cells * sizeof *deviations);
    sum_cells(&s);
    take_samples(&s);
    found->count = 0;
    found->within_q8 = width_of(&s, suppose(&s, deviations));
    for (uint32_t h = 0; h < s.hypotheses; h++) {
        s.hypothesis[h].samples = count_on(&s, &s.hypothesis[h].plane, found->within_q8);
    }
    while (s.hypotheses > 0 && found->count < T3R_PLANES_MOST) {
        const t3r_plane_hypothesis *best = best_of(&s, found);
        if (LEAST_SHARE * best->samples < s.samples) {
            break;
        }
        t3r_plane plane = refined(&s, best->plane, found->within_q8);
        if (count_on(&s, &plane, found->within_q8) < best->samples) {
            plane = best->plane;
        }
        take_away(&s, &plane, found->within_q8);
        found->plane[found->count++] = plane;
    }
}
