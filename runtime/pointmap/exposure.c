/* SPDX-License-Identifier: Apache-2.0 */
#include "exposure.h"

#include <stdbool.h>

#include "core/fixed.h"
#include "core/memory.h"
#include "reproject.h"

#define STEP 2 /* stride of the compared pixels */
#define LEVEL_LEAST 16
#define LEVEL_MOST 239
#define PAIRS_LEAST 256
#define BINS T3R_RATIO_BINS /* one for each value of log2 of a ratio in Q8, -1..1 */

static bool well_exposed(const t3r_view *view, size_t pixel)
{
    for (int c = 0; c < 3; c++) {
        if (view->colour[c][pixel] < LEVEL_LEAST || view->colour[c][pixel] > LEVEL_MOST) {
            return false;
        }
    }
    return true;
}

static bool is_pair(const t3r_pointmap *from, size_t pixel, const t3r_pointmap *to, size_t place, int32_t z_q20)
{
    if (!t3r_is_reliable(to->view->validity[place])) {
        return false;
    }
    int32_t there = t3r_depth_q20(to->scale, to->view->depth[place]);
    return t3r_is_one_surface(z_q20, there, 64) && well_exposed(from->view, pixel) && well_exposed(to->view, place);
}

typedef struct pairs_job {
    t3r_pointmap from, to;
    const t3r_kernels *kernels;
    uint32_t *partner; /* for each compared pixel, row by row: its partner in `to`, or T3R_NO_PIXEL */
} pairs_job;

static uint32_t asked(uint32_t side)
{
    return (side + STEP - 1) / STEP;
}

static void find_partners(const pairs_job *job, t3r_points *points, const t3r_unprojection *from)
{
    const t3r_pinhole to = t3r_pinhole_of(job->to.view);
    const uint32_t width = job->from.view->width;
    t3r_places places;
    job->kernels->unproject(from, points);
    job->kernels->locate(&to, points, &places);
    for (uint32_t i = 0; i < points->count; i++) {
        const uint32_t u = points->u[i], v = points->v[i], place = places.pixel[i];
        if (place != T3R_NO_PIXEL && is_pair(&job->from, (size_t)v * width + u, &job->to, place, places.z_q20[i])) {
            job->partner[(size_t)(v / STEP) * asked(width) + u / STEP] = place;
        }
    }
    points->count = 0;
}

static void pair_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const pairs_job *job = context;
    const t3r_view *view = job->from.view;
    const t3r_unprojection from = t3r_unprojection_of(&job->from);
    t3r_points points = {0};
    for (uint32_t row = begin; row < end; row++) {
        for (uint32_t column = 0; column < asked(view->width); column++) {
            job->partner[(size_t)row * asked(view->width) + column] = T3R_NO_PIXEL;
            if (t3r_is_reliable(view->validity[(size_t)row * STEP * view->width + column * STEP])) {
                t3r_add_pixel(&points, view, column * STEP, row * STEP);
            }
            if (t3r_is_full(&points)) {
                find_partners(job, &points, &from);
            }
        }
        find_partners(job, &points, &from);
    }
}

/* Counts the log ratios of `from` to `to`, whose level is level_q8 above the first view's. Returns the number of
 * pairs. */
static uint32_t compare(const pairs_job *job, const int16_t level_q8[3], uint32_t bin[3][BINS])
{
    int32_t log_q16[LEVEL_MOST + 1] = {0};
    for (uint32_t level = LEVEL_LEAST; level <= LEVEL_MOST; level++) {
        log_q16[level] = t3r_log2_q16(level);
    }
    uint32_t pairs = 0;
    const t3r_view *from = job->from.view, *to = job->to.view;
    for (uint32_t row = 0; row < asked(from->height); row++) {
        for (uint32_t column = 0; column < asked(from->width); column++) {
            const uint32_t place = job->partner[(size_t)row * asked(from->width) + column];
            if (place == T3R_NO_PIXEL) {
                continue;
            }
            const size_t pixel = (size_t)row * STEP * from->width + column * STEP;
            for (int c = 0; c < 3; c++) {
                int32_t ratio_q16 = log_q16[from->colour[c][pixel]] - log_q16[to->colour[c][place]];
                bin[c][t3r_clamp32(t3r_round_shift32(ratio_q16, 8) + level_q8[c] + BINS / 2, 0, BINS - 1)]++;
            }
            pairs++;
        }
    }
    return pairs;
}

/* Returns the smallest ratio that at least half of the pairs don't exceed, log2 in Q8. */
static int32_t median_q8(const uint32_t bin[BINS], uint32_t count)
{
    uint32_t sum = 0;
    for (int32_t i = 0; i < BINS - 1; i++) {
        sum += bin[i];
        if (2 * (uint64_t)sum >= count) {
            return i - BINS / 2;
        }
    }
    return BINS / 2 - 1;
}

uint32_t t3r_exposure_gains(const t3r_view *views, uint32_t count, int32_t exponent, uint16_t gain_q14[][3],
                            const t3r_pointmap_work *work)
{
    int16_t level_q8[T3R_MAX_VIEWS][3] = {{0}};
    int32_t sum_q8[3] = {0};
    bool linked[T3R_MAX_VIEWS] = {true};
    int32_t links = 1;
    for (uint32_t v = 1; v < count; v++) {
        uint32_t pairs = 0;
        memset(work->ratios, 0, 3 * sizeof *work->ratios);
        for (uint32_t w = 0; w < v; w++) {
            if (linked[w]) {
                pairs_job job = {t3r_pointmap_of(&views[v], exponent), t3r_pointmap_of(&views[w], exponent),
                                 work->kernels, work->pixels};
                t3r_run_rows(&work->workers, asked(views[v].height), pair_rows, &job);
                pairs += compare(&job, level_q8[w], work->ratios);
            }
        }
        linked[v] = pairs >= PAIRS_LEAST;
        links += linked[v];
        for (int c = 0; c < 3 && linked[v]; c++) {
            level_q8[v][c] = (int16_t)median_q8(work->ratios[c], pairs);
            sum_q8[c] += level_q8[v][c];
        }
    }
    for (uint32_t v = 0; v < count; v++) {
        for (int c = 0; c < 3; c++) {
            int32_t mean_q8 = (int32_t)t3r_round_div64(sum_q8[c], links);
            /* Levels are within an octave of the first view's, and the mean over at most 16 views includes this one.
             * So they differ by less than 2 octaves minus a 16th either way: gains are below 2^15.9. */
            int32_t over = linked[v] ? level_q8[v][c] - mean_q8 : 0;
            gain_q14[v][c] = (uint16_t)t3r_round_shift32((int32_t)t3r_exp2_q16(-over * 256), 2);
        }
    }
    return (uint32_t)links;
}
