/* SPDX-License-Identifier: Apache-2.0 */
#include "stream_density.h"

#include "budget/budget_keys.h"
#include "core/fixed.h"
#include "core/logarithm.h"
#include "core/memory.h"
#include "pointmap/reproject.h"

#define RADIUS_SPACINGS_Q4 32 /* radius of a Gaussian's disc: two spacings, */
#define RADIUS_MOST 16        /* at most so many pixels */
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

/* --- discs -------------------------------------------------------------------------------------------------------- */

/* The pixels around a Gaussian's centre, and the depth steps of its surface. */
typedef struct disc {
    int32_t u, v, radius_q4;
    uint32_t nearest, farthest; /* depth steps, at least 1 */
    int32_t density_q10;        /* log2 of the noted density, a pixel of the keyframe */
} disc;

/* A row of a disc: `pixels` in all, of which `inside` lie in the picture, from `first` on. */
typedef struct disc_row {
    size_t first;
    uint32_t inside, pixels;
} disc_row;

/* Returns the view with a margin as wide as a disc. */
static t3r_pinhole widened(const t3r_view *view)
{
    t3r_pinhole wide = t3r_pinhole_of(view);
    wide.width += 2 * RADIUS_MOST;
    wide.height += 2 * RADIUS_MOST;
    wide.cx_q16 += RADIUS_MOST << 16;
    wide.cy_q16 += RADIUS_MOST << 16;
    return wide;
}

/* Returns false if the disc is not in the picture. */
static bool disc_of(const t3r_map_density *density, uint32_t index, disc *d)
{
    const t3r_view *view = density->keyframe->view;
    const t3r_map_record *record = &density->map->records[index];
    const t3r_pinhole wide = widened(view);
    int32_t z_q20;
    const uint32_t pixel = t3r_locate_point(&wide, density->map->gaussians[index].position_q20, &z_q20);
    if (pixel == T3R_NO_PIXEL) {
        return false;
    }
    d->u = (int32_t)(pixel % wide.width) - RADIUS_MOST;
    d->v = (int32_t)(pixel / wide.width) - RADIUS_MOST;
    d->density_q10 = record->density_q10 + 8 * (t3r_grain_q8(view, z_q20) - record->grain_q8);
    const int32_t log_spacing_q10 = t3r_clamp32(-d->density_q10 / 2, -2048, 4096);
    d->radius_q4 = (int32_t)(t3r_exp2_q16(log_spacing_q10 * 64) * RADIUS_SPACINGS_Q4 >> 16);
    d->radius_q4 = T3R_MIN(d->radius_q4, RADIUS_MOST << 4);
    const int64_t f_q16 = ((int64_t)view->fx_q16 + view->fy_q16) / 2;
    const int64_t off_q20 = ((int64_t)z_q20 * d->radius_q4 << 12) / f_q16 + z_q20 / 16; /* 2^31 x 2^8 x 2^12 */
    const t3r_depth_scale scale = density->keyframe->scale;
    d->nearest = T3R_MAX(t3r_depth_steps(scale, (uint32_t)T3R_MAX(z_q20 - off_q20, 0)), 1);
    d->farthest = t3r_depth_steps(scale, (uint32_t)T3R_MIN(z_q20 + off_q20, INT32_MAX));
    return true;
}

static bool reaches(const disc *d, uint32_t begin, uint32_t end)
{
    return d->v + (d->radius_q4 >> 4) >= (int32_t)begin && d->v - (d->radius_q4 >> 4) < (int32_t)end;
}

/* Returns row y, -radius..radius, of the disc. */
static disc_row row_of(const t3r_view *view, const disc *d, int32_t y)
{
    int32_t half = d->radius_q4 >> 4;
    while ((half * half + y * y) * 256 > d->radius_q4 * d->radius_q4) {
        half--;
    }
    const int32_t row = d->v + y, begin = T3R_MAX(d->u - half, 0), end = T3R_MIN(d->u + half + 1, (int32_t)view->width);
    disc_row r = {.pixels = 2 * (uint32_t)half + 1};
    if (row >= 0 && row < (int32_t)view->height && begin < end) {
        r.first = (size_t)row * view->width + (size_t)begin;
        r.inside = (uint32_t)(end - begin);
    }
    return r;
}

/* Whether the pixel shows the disc's surface: any, where its own depth is bridged. */
static inline bool is_on(const t3r_view *view, const disc *d, size_t pixel)
{
    const uint32_t steps = view->depth[pixel];
    return (steps >= d->nearest && steps <= d->farthest) || t3r_is_bridged(view->validity[pixel]);
}

/* Returns the size of the disc's surface in pixels. Outside the picture it goes on. */
static uint32_t surface_of(const t3r_view *view, const disc *d)
{
    uint32_t outside = 0, on = 0;
    for (int32_t y = -(d->radius_q4 >> 4); y <= d->radius_q4 >> 4; y++) {
        const disc_row r = row_of(view, d, y);
        outside += r.pixels - r.inside;
        for (uint32_t x = 0; x < r.inside; x++) {
            on += is_on(view, d, r.first + x);
        }
    }
    return on > 0 ? outside + on : 0;
}

/* --- the plane ---------------------------------------------------------------------------------------------------- */

static void spread_over_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const t3r_map_density *density = context;
    const t3r_view *view = density->keyframe->view;
    memset(density->plane_q16 + (size_t)begin * view->width, 0,
           (size_t)(end - begin) * view->width * sizeof *density->plane_q16);
    for (uint32_t i = 0; i < density->map->count; i++) {
        disc d;
        if (!disc_of(density, i, &d) || !reaches(&d, begin, end)) {
            continue;
        }
        const uint32_t surface = surface_of(view, &d);
        const uint32_t share_q16 = surface > 0 ? (1u << 16) / surface : 0;
        const int32_t first = T3R_MAX(d.v - (d.radius_q4 >> 4), (int32_t)begin);
        const int32_t last = T3R_MIN(d.v + (d.radius_q4 >> 4), (int32_t)end - 1);
        for (int32_t y = first; y <= last && share_q16 > 0; y++) {
            const disc_row r = row_of(view, &d, y - d.v);
            for (size_t at = r.first; at < r.first + r.inside; at++) {
                const uint32_t more = density->plane_q16[at] + (is_on(view, &d, at) ? share_q16 : 0);
                density->plane_q16[at] = T3R_MIN(more, DENSITY_MOST_Q16);
            }
        }
    }
}

void t3r_map_density_find(const t3r_map_density *density)
{
    t3r_run_rows(density->workers, density->keyframe->view->height, spread_over_rows, (void *)(uintptr_t)density);
}

static int32_t log_density_q10(uint32_t density_q16)
{
    return t3r_round_shift32(t3r_log2_q16(density_q16) - (16 << 16), 6);
}

/* Returns the mean over the disc's surface in the picture, 0 if there is none. */
static uint32_t mean_density_q16(const t3r_map_density *density, const disc *d)
{
    const t3r_view *view = density->keyframe->view;
    uint64_t sum_q16 = 0;
    uint32_t pixels = 0;
    for (int32_t y = -(d->radius_q4 >> 4); y <= d->radius_q4 >> 4; y++) {
        const disc_row r = row_of(view, d, y);
        for (size_t at = r.first; at < r.first + r.inside; at++) {
            const bool on = is_on(view, d, at);
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
        disc d;
        if (record->idle <= T3R_MAX_VIEWS) { /* refinement may have changed it */
            t3r_map_hold_width(g, record);
        }
        if (record->idle != 0) {
            continue;
        }
        const uint32_t mean_q16 = disc_of(density, i, &d) ? mean_density_q16(density, &d) : 0;
        const int32_t off_q10 = mean_q16 > 0 ? log_density_q10(mean_q16) - d.density_q10 : 0;
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
    t3r_run_rows(density->workers, density->map->count, fit_some, (void *)(uintptr_t)density);
}

/* --- the keyframe's points ---------------------------------------------------------------------------------------- */

void t3r_map_density_raise_keys(const t3r_map_density *density, const t3r_budget_settings *settings)
{
    const t3r_view *view = density->keyframe->view;
    const size_t pixels = (size_t)view->width * view->height;
    for (size_t i = 0; i < pixels; i++) {
        uint32_t *least = &density->plane_q16[i], key = T3R_MAP_KEY_LEAST;
        if (*least > 0) {
            const int32_t taken_q10 = log_density_q10(*least) + TAKEN_Q10;
            const int32_t raised = T3R_KEY_ZERO + taken_q10 - t3r_log_wanted_q10(view->texture[i], settings);
            key = (uint32_t)t3r_clamp32(raised, T3R_MAP_KEY_LEAST, UINT16_MAX);
            *least = taken_q10 > 0 ? NO_KEY_LEFT : key;
        }
        view->key[i] = (uint16_t)T3R_MAX((uint32_t)view->key[i], key);
    }
    (void)t3r_map_density_mark(density, UINT16_MAX);
}

uint32_t t3r_map_density_mark(const t3r_map_density *density, uint32_t threshold)
{
    const t3r_view *view = density->keyframe->view;
    const size_t pixels = (size_t)view->width * view->height;
    uint32_t covered = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (density->plane_q16[i] > threshold && t3r_has_depth(view->validity[i])) {
            view->validity[i] = t3r_marked(view->validity[i], T3R_MARK_COVERED);
            covered++;
        }
    }
    return covered;
}
