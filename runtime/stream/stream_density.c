/* SPDX-License-Identifier: Apache-2.0 */
#include "stream_density.h"

#include "budget/budget_keys.h"
#include "core/fixed.h"
#include "core/logarithm.h"
#include "core/memory.h"

#define DENSITY_MOST_Q16 (1u << 30)

#define TAKEN_Q10 2048 /* log2: thresholds up to four times the density are taken */
#define NO_KEY_LEFT (UINT16_MAX + 1u)

/* log2: smaller differences between measured and noted density are chance. A keyframe halves larger ones, by at most
 * so much. */
#define CHANCE_Q10 256
#define STEP_MOST_Q10 256

/* Gaussians leave whose threshold is this much, log2, above what one Gaussian a pixel leaves, and those of less opacity
 * than 1/32 after four keyframes. */
#define EXCESS_Q10 512
#define FAINT_Q15 1024
#define FITTED_LEAST 4

/* --- the plane ---------------------------------------------------------------------------------------------------- */

/* Adds the disc's share to those of its pixels that are in rows begin..end - 1. */
static void spread(const t3r_map_density *density, const t3r_map_disc *disc, int32_t begin, int32_t end)
{
    const t3r_view *view = density->keyframe->view;
    const int32_t radius = disc->radius_q4 >> 4;
    const int32_t first = T3R_MAX(disc->v - radius, begin), last = T3R_MIN(disc->v + radius, end - 1);
    if (disc->surface == 0 || first > last) {
        return;
    }
    const t3r_disc_shape shape = t3r_disc_shape_of(disc);
    const uint32_t share_q16 = (1u << 16) / disc->surface;
    for (int32_t y = first; y <= last; y++) {
        const t3r_disc_row r = t3r_disc_row_of(view, disc, &shape, y - disc->v);
        for (size_t at = r.first; at < r.first + r.inside; at++) {
            const uint32_t more = density->plane_q16[at] + (t3r_is_on_disc(view, disc, at) ? share_q16 : 0);
            density->plane_q16[at] = T3R_MIN(more, DENSITY_MOST_Q16);
        }
    }
}

static void spread_over_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const t3r_map_density *density = context;
    const size_t width = density->keyframe->view->width;
    memset(density->plane_q16 + begin * width, 0, (end - begin) * width * sizeof *density->plane_q16);
    for (uint32_t i = 0; i < density->map->count; i++) {
        spread(density, &density->discs[i], (int32_t)begin, (int32_t)end);
    }
}

void t3r_map_density_find(const t3r_map_density *density)
{
    t3r_map_discs_find(density->map, density->keyframe, density->workers, density->discs);
    t3r_map_density job = *density;
    t3r_run_rows(density->workers, density->keyframe->view->height, spread_over_rows, &job);
}

static int32_t log_density_q10(uint32_t density_q16)
{
    return t3r_round_shift32(t3r_log2_q16(density_q16) - (16 << 16), 6);
}

/* Returns the mean over the disc's surface in the picture, 0 if there is none. */
static uint32_t mean_density_q16(const t3r_map_density *density, const t3r_map_disc *disc)
{
    const t3r_view *view = density->keyframe->view;
    const t3r_disc_shape shape = t3r_disc_shape_of(disc);
    uint64_t sum_q16 = 0;
    uint32_t pixels = 0;
    for (int32_t y = -shape.radius; y <= shape.radius; y++) {
        const t3r_disc_row r = t3r_disc_row_of(view, disc, &shape, y);
        for (size_t at = r.first; at < r.first + r.inside; at++) {
            const bool on = t3r_is_on_disc(view, disc, at);
            sum_q16 += on ? density->plane_q16[at] : 0;
            pixels += on;
        }
    }
    return pixels > 0 ? (uint32_t)(sum_q16 / pixels) : 0;
}

/* Whether several keyframes have fitted it and made it faint. */
static bool is_faint(const t3r_gaussian *g, const t3r_map_record *record)
{
    return record->fitted >= FITTED_LEAST && g->opacity_q15 < FAINT_Q15;
}

/* Whether it is among those too many where Gaussians are denser than one a pixel. Its key holds its threshold, which is
 * uniform among them. */
static bool is_in_excess(const t3r_map_record *record, int32_t density_q10)
{
    return record->key + record->wanted_q10 - T3R_KEY_ZERO + density_q10 > EXCESS_Q10;
}

static void fit_some(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const t3r_map_density *density = context;
    for (uint32_t i = begin; i < end; i++) {
        t3r_gaussian *g = &density->map->gaussians[i];
        t3r_map_record *record = &density->map->records[i];
        const t3r_map_disc *disc = &density->discs[i];
        if (record->idle <= T3R_MAX_VIEWS) { /* refinement may have changed it */
            t3r_map_hold_width(g, record);
        }
        if (record->idle != 0) {
            continue;
        }
        const uint32_t mean_q16 = disc->surface > 0 ? mean_density_q16(density, disc) : 0;
        const int32_t off_q10 = mean_q16 > 0 ? log_density_q10(mean_q16) - disc->density_q10 : 0;
        if (is_faint(g, record) || is_in_excess(record, record->density_q10 + off_q10)) {
            record->key = T3R_MAP_KEY_LEAVES;
        }
        if (t3r_abs32(off_q10) > CHANCE_Q10) {
            const int32_t step_q10 = t3r_clamp32(off_q10 / 2, -STEP_MOST_Q10, STEP_MOST_Q10);
            t3r_map_set_density(g, record, record->density_q10 + step_q10);
        }
    }
}

void t3r_map_density_fit(const t3r_map_density *density)
{
    t3r_map_density job = *density;
    t3r_run_rows(density->workers, density->map->count, fit_some, &job);
}

/* --- the keyframe's points ---------------------------------------------------------------------------------------- */

/* The points of rows, whose keys are raised. */
typedef struct raise_job {
    const t3r_map_density *density;
    const t3r_budget_settings *settings;
    const t3r_kernels *kernels;
} raise_job;

/* Returns the least key that the density leaves, and sets *least to it, or to NO_KEY_LEFT. */
static uint32_t least_key(uint32_t *least, uint32_t wanted_q10)
{
    if (*least == 0) {
        return T3R_MAP_KEY_LEAST;
    }
    const int32_t taken_q10 = log_density_q10(*least) + TAKEN_Q10;
    const int32_t raised = T3R_KEY_ZERO + taken_q10 - (int32_t)wanted_q10;
    const uint32_t key = (uint32_t)t3r_clamp32(raised, T3R_MAP_KEY_LEAST, UINT16_MAX);
    *least = taken_q10 > 0 ? NO_KEY_LEFT : key;
    return key;
}

static void raise_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const raise_job *job = context;
    const t3r_view *view = job->density->keyframe->view;
    const size_t last = (size_t)end * view->width;
    for (size_t at = (size_t)begin * view->width; at < last; at += T3R_KEY_RUN) {
        const uint32_t count = (uint32_t)T3R_MIN(last - at, (size_t)T3R_KEY_RUN);
        uint16_t wanted_q10[T3R_KEY_RUN];
        t3r_find_wanted(job->settings, job->kernels, view->texture + at, count, wanted_q10);
        for (uint32_t x = 0; x < count; x++) {
            const uint32_t key = least_key(&job->density->plane_q16[at + x], wanted_q10[x]);
            view->key[at + x] = (uint16_t)T3R_MAX((uint32_t)view->key[at + x], key);
        }
    }
}

void t3r_map_density_raise_keys(const t3r_map_density *density, const t3r_budget_settings *settings,
                                const t3r_kernels *kernels)
{
    raise_job job = {.density = density, .settings = settings, .kernels = kernels};
    t3r_run_rows(density->workers, density->keyframe->view->height, raise_rows, &job);
    (void)t3r_map_density_mark(density, UINT16_MAX);
}

uint32_t t3r_map_density_mark(const t3r_map_density *density, uint32_t threshold)
{
    const t3r_view *view = density->keyframe->view;
    const size_t pixels = (size_t)view->width * view->height;
    uint32_t covered = 0;
    for (size_t i = 0; i < pixels; i++) {
        const bool is_covered = (density->plane_q16[i] > threshold) & t3r_has_depth(view->validity[i]);
        view->validity[i] |= (uint8_t)(is_covered ? T3R_MARK_COVERED : 0);
        covered += is_covered;
    }
    return covered;
}
