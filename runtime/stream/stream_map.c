/* SPDX-License-Identifier: Apache-2.0 */
#include "stream_map.h"

#include "budget/budget_keys.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "head/head.h"
#include "pointmap/contradiction.h"
#include "pointmap/reproject.h"
#include "state/state.h"

#define FINER_Q8 256        /* log2: a keyframe with pixels this much narrower on the surface replaces the Gaussian */
#define ALIKE_Q7 (72 << 7)  /* levels, of the three channels together */
#define LOST_Q10 2048       /* log2: a Gaussian that has faded so far and is hidden leaves */
#define WIDEN_STEP_Q10 64   /* log2 of density: smaller changes wait until they add up */
#define SCALE_MOST_Q10 4096 /* log2: bound of one step of the width */
#define WIDTH_MOST_Q10 2048 /* log2: widths are within a quarter of the spacing and four times it */

t3r_map t3r_map_of(const t3r_runtime *rt)
{
    return (t3r_map){t3r_buffer_at(rt, T3R_BUFFER_SCENE), t3r_buffer_at(rt, T3R_BUFFER_MAP_RECORDS), rt->gaussians};
}

int32_t t3r_grain_q8(const t3r_view *view, int32_t z_q20)
{
    int32_t log_z = t3r_log2_q16((uint32_t)T3R_MAX(z_q20, 1));
    int32_t log_f = t3r_log2_q16((uint32_t)view->fx_q16 + (uint32_t)view->fy_q16);
    return t3r_round_shift32(log_z - log_f, 8);
}

bool t3r_map_is_alike(const t3r_gaussian *g, const t3r_view *view, size_t pixel)
{
    int32_t off_q7 = 0;
    for (int c = 0; c < 3; c++) {
        off_q7 += t3r_abs32(g->colour_q7[c] - view->colour[c][pixel] * 128);
    }
    return off_q7 <= ALIKE_Q7;
}

t3r_pinhole t3r_map_wide_picture(const t3r_view *view)
{
    t3r_pinhole wide = t3r_pinhole_of(view);
    wide.width += 2 * T3R_MAP_MARGIN;
    wide.height += 2 * T3R_MAP_MARGIN;
    wide.cx_q16 += T3R_MAP_MARGIN << 16;
    wide.cy_q16 += T3R_MAP_MARGIN << 16;
    return wide;
}

typedef enum look { AWAY, UNSEEN, HIDDEN, SEEN_AFAR, SEEN, CONTRADICTED, COARSE } look;

/* Returns how a Gaussian outside the picture is seen. */
static look look_beside(const t3r_gaussian *g, const t3r_view *view)
{
    const t3r_pinhole wide = t3r_map_wide_picture(view);
    int32_t z_q20;
    return t3r_locate_point(&wide, g->position_q20, &z_q20) != T3R_NO_PIXEL ? UNSEEN : AWAY;
}

static look look_at(const t3r_gaussian *g, const t3r_map_record *record, const t3r_pointmap *keyframe)
{
    const t3r_view *view = keyframe->view;
    t3r_projected_pixel projected;
    if (!t3r_project_to_pixel(view, g->position_q20, &projected)) {
        return look_beside(g, view);
    }
    /* a Gaussian of an earlier piece has no place that can be trusted: it may be neither hidden nor unseen, and where
     * it is on the surface it must have the surface's colour */
    const bool earlier = record->fitted == T3R_EARLIER_PIECE;
    if (!t3r_is_measured(view->validity[projected.pixel])) {
        return earlier ? CONTRADICTED : UNSEEN;
    }
    int32_t there = t3r_depth_q20(keyframe->scale, view->depth[projected.pixel]);
    if (t3r_is_one_surface(there, projected.z_q20, 16)) {
        int32_t wider_q8 = t3r_grain_q8(view, projected.z_q20) - record->grain_q8;
        return earlier && !t3r_map_is_alike(g, view, projected.pixel) ? CONTRADICTED
               : wider_q8 < -FINER_Q8                                 ? COARSE
               : wider_q8 <= T3R_AFAR_Q8                              ? SEEN
                                                                      : SEEN_AFAR;
    }
    return earlier || t3r_seen_through(keyframe, &projected, false) ? CONTRADICTED : HIDDEN;
}

static void move_to(t3r_map *map, uint32_t from, uint32_t to)
{
    if (from != to) {
        map->gaussians[to] = map->gaussians[from];
        map->records[to] = map->records[from];
    }
}

/* Returns the current keyframe's part of an octave spread over `half_life` keyframes. */
static uint32_t fade_q10(uint32_t keyframes, uint32_t half_life)
{
    if (half_life == 0) {
        return 0;
    }
    uint32_t at = keyframes % half_life;
    return ((at + 1) << 10) / half_life - (at << 10) / half_life;
}

typedef struct look_job {
    const t3r_map *map;
    const t3r_pointmap *keyframe;
    uint8_t *looks;
} look_job;

static void look_at_some(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const look_job *job = context;
    for (uint32_t i = begin; i < end; i++) {
        job->looks[i] = (uint8_t)look_at(&job->map->gaussians[i], &job->map->records[i], job->keyframe);
    }
}

static void look_at_all(const t3r_map *map, const t3r_pointmap *keyframe, const t3r_workers *workers, uint8_t *looks)
{
    look_job job = {.map = map, .keyframe = keyframe, .looks = looks};
    t3r_run_rows(workers, map->count, look_at_some, &job);
}

static void note_idle(t3r_map_record *record, look seen)
{
    record->idle = seen == SEEN ? 0 : (uint8_t)T3R_MIN(record->idle + 1, UINT8_MAX);
}

void t3r_map_look(t3r_map *map, const t3r_pointmap *keyframe, const t3r_workers *workers, uint8_t *looks)
{
    look_at_all(map, keyframe, workers, looks);
    for (uint32_t i = 0; i < map->count; i++) {
        note_idle(&map->records[i], (look)looks[i]);
    }
}

uint32_t t3r_map_see(t3r_map *map, const t3r_pointmap *keyframe, uint32_t keyframes, uint32_t half_life,
                     const t3r_workers *workers, uint8_t *looks)
{
    const uint32_t fade = fade_q10(keyframes, half_life);
    look_at_all(map, keyframe, workers, looks);
    uint32_t kept = 0;
    for (uint32_t i = 0; i < map->count; i++) {
        t3r_map_record *record = &map->records[i];
        const look seen = (look)looks[i];
        if (seen == CONTRADICTED || seen == COARSE || (seen == HIDDEN && record->faded_q10 >= LOST_Q10)) {
            continue;
        }
        note_idle(record, seen);
        if (seen == SEEN) {
            record->fitted = (uint8_t)T3R_MIN(record->fitted + 1, T3R_FITTED_MOST);
        }
        if (seen == SEEN || seen == SEEN_AFAR) {
            record->faded_q10 = 0;
        } else if (seen != UNSEEN) { /* else its surroundings are seen and stay: it must not widen alone */
            record->faded_q10 = (uint16_t)T3R_MIN(record->faded_q10 + fade, (uint32_t)UINT16_MAX);
        }
        move_to(map, i, kept++);
    }
    uint32_t left = map->count - kept;
    map->count = kept;
    return left;
}

uint32_t t3r_map_drop(t3r_map *map)
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < map->count; i++) {
        if (map->records[i].key != T3R_MAP_KEY_LEAVES) {
            move_to(map, i, kept++);
        }
    }
    const uint32_t left = map->count - kept;
    map->count = kept;
    return left;
}

static uint32_t key_of(const t3r_map_record *record)
{
    return T3R_MIN((uint32_t)record->key + record->faded_q10, (uint32_t)UINT16_MAX);
}

static bool competes(const t3r_view *view, size_t pixel, const t3r_budget_settings *settings)
{
    return t3r_has_depth(view->validity[pixel]) && !t3r_is_deferred(view, pixel, settings);
}

/* Numbers of Gaussians and points for each of 256 values of a byte of the key. */
typedef struct counts {
    uint32_t gaussians[256], points[256];
} counts;

/* Counts by the upper byte, or with `upper` by the lower byte of keys with that upper one. */
#define ANY_UPPER 256u
static void count_key(uint32_t key, uint32_t upper, uint32_t counted[256])
{
    if (upper == ANY_UPPER) {
        counted[key >> 8]++;
    } else {
        counted[key & 255] += key >> 8 == upper;
    }
}

static void count_keys(const t3r_map *map, const t3r_view *view, const t3r_budget_settings *settings, uint32_t upper,
                       counts *n)
{
    memset(n, 0, sizeof *n);
    for (uint32_t i = 0; i < map->count; i++) {
        count_key(key_of(&map->records[i]), upper, n->gaussians);
    }
    const size_t pixels = (size_t)view->width * view->height;
    for (size_t i = 0; i < pixels; i++) {
        if (competes(view, i, settings)) {
            count_key(view->key[i], upper, n->points);
        }
    }
}

/* Returns the last byte value below which fewer than `most` are counted; adds up the counts below it. */
static uint32_t pass(const counts *n, uint32_t most, uint32_t *gaussians, uint32_t *points)
{
    uint32_t at = 0;
    while (at < 255 && *gaussians + *points + n->gaussians[at] + n->points[at] < most) {
        *gaussians += n->gaussians[at];
        *points += n->points[at++];
    }
    return at;
}

t3r_map_cut t3r_map_compete(const t3r_map *map, const t3r_view *view, const t3r_budget_settings *settings,
                            uint32_t most)
{
    /* finds the least threshold with at least `most` keys not above it, byte by byte */
    counts n;
    uint32_t gaussians = 0, points = 0; /* below the threshold */
    count_keys(map, view, settings, ANY_UPPER, &n);
    const uint32_t upper = pass(&n, most, &gaussians, &points);
    count_keys(map, view, settings, upper, &n);
    const uint32_t lower = pass(&n, most, &gaussians, &points);
    const uint32_t places = most - gaussians - points;
    const uint32_t more_points = T3R_MIN(n.points[lower], places);
    const uint32_t ties = T3R_MIN(n.gaussians[lower], places - more_points);
    return (t3r_map_cut){upper << 8 | lower, ties, more_points, points + more_points, gaussians + ties};
}

/* Multiplies the width by the scale, below 2^32. */
static void scale_width(t3r_gaussian *g, int64_t scale_q24)
{
    int64_t entry[9];
    for (int i = 0; i < 9; i++) {
        entry[i] = g->factor[i] * scale_q24;
    }
    t3r_pack_factor(entry, 24 - g->factor_exponent, g);
}

/* Returns the spacing of a density in pixels, Q16: below 2^21. */
static uint32_t spacing_q16(int32_t density_q10)
{
    return t3r_exp2_q16(-t3r_clamp32(density_q10, T3R_LEAST_DENSITY_Q10, 0) * 32);
}

void t3r_map_set_density(t3r_gaussian *g, t3r_map_record *record, int32_t density_q10)
{
    density_q10 = t3r_clamp32(density_q10, T3R_LEAST_DENSITY_Q10, 0);
    /* by a quotient of spacings, so that the width returns when the density does */
    const uint32_t before_q16 = spacing_q16(record->density_q10), now_q16 = spacing_q16(density_q10);
    scale_width(g, (((int64_t)now_q16 << 24) + before_q16 / 2) / before_q16);
    record->density_q10 = (int16_t)density_q10;
}

/* Returns log2 of the width in spacings of its density, of the root of the factor's sum of squares. */
static int32_t log_width_q10(const t3r_gaussian *g, const t3r_map_record *record)
{
    uint64_t squares = 1; /* below 2^34 */
    for (int i = 0; i < 9; i++) {
        squares += (uint64_t)((int64_t)g->factor[i] * g->factor[i]);
    }
    const int32_t log_q10 = (t3r_log2_wide_q16(squares) >> 7) + g->factor_exponent * 1024;
    const int32_t pixel_q10 = record->grain_q8 * 4 + (16 - 20 + 1) * 1024; /* z / f */
    return log_q10 - pixel_q10 + record->density_q10 / 2;
}

void t3r_map_hold_width(t3r_gaussian *g, const t3r_map_record *record)
{
    const int32_t width_q10 = log_width_q10(g, record);
    const int32_t held_q10 = t3r_clamp32(width_q10, -WIDTH_MOST_Q10, WIDTH_MOST_Q10);
    if (held_q10 != width_q10) {
        const int32_t by_q10 = t3r_clamp32(held_q10 - width_q10, -SCALE_MOST_Q10, SCALE_MOST_Q10);
        scale_width(g, (int64_t)t3r_exp2_q16(by_q10 * 64) << 8);
    }
}

void t3r_map_thin(t3r_map *map, const t3r_map_cut *cut)
{
    const bool all_stay = cut->threshold == UINT16_MAX; /* none left, so that nothing thinned out */
    uint32_t ties = 0, kept = 0;
    for (uint32_t i = 0; i < map->count; i++) {
        ties += key_of(&map->records[i]) == cut->threshold;
    }
    for (uint32_t i = 0; i < map->count; i++) {
        t3r_map_record *record = &map->records[i];
        uint32_t key = key_of(record);
        bool stays = key < cut->threshold;
        if (key == cut->threshold) {
            stays = ties <= cut->ties;
            ties--;
        }
        if (!stays) {
            continue;
        }
        const int32_t density_q10 = (int32_t)cut->threshold - T3R_KEY_ZERO + record->wanted_q10 - record->faded_q10;
        if (!all_stay && record->density_q10 - T3R_MAX(density_q10, T3R_LEAST_DENSITY_Q10) >= WIDEN_STEP_Q10) {
            t3r_map_set_density(&map->gaussians[i], record, density_q10);
        }
        move_to(map, i, kept++);
    }
    map->count = kept;
}

static bool in_range(const int64_t position_q20[3])
{
    bool inside = true;
    for (int i = 0; i < 3; i++) {
        inside = inside && t3r_abs64(position_q20[i]) < T3R_POSITION_MOST_Q20;
    }
    return inside;
}

uint32_t t3r_map_append(t3r_map *map, uint32_t count, const t3r_pointmap *keyframe, const t3r_budget_settings *settings,
                        const t3r_cluster *clusters)
{
    const t3r_view *view = keyframe->view;
    size_t pixel = 0;
    uint32_t before = map->count;
    for (uint32_t i = 0; i < count; i++, pixel++) {
        while (!t3r_retained(view, pixel)) {
            pixel++; /* the head made one Gaussian for each of these, in this order */
        }
        const int32_t *p_q20 = map->gaussians[before + i].position_q20;
        if (!in_range((const int64_t[3]){p_q20[0], p_q20[1], p_q20[2]})) {
            continue;
        }
        map->gaussians[map->count] = map->gaussians[before + i];
        map->records[map->count++] = (t3r_map_record){
            .key = view->key[pixel],
            .wanted_q10 = (int16_t)T3R_MIN(t3r_log_wanted_q10(view->texture[pixel], settings), INT16_MAX),
            .density_q10 = (int16_t)t3r_log_density_q10(view, pixel, settings, clusters),
            .grain_q8 = (int16_t)t3r_grain_q8(view, t3r_depth_q20(keyframe->scale, view->depth[pixel])),
        };
    }
    return map->count - before;
}

void t3r_map_begin_piece(t3r_map *map)
{
    for (uint32_t i = 0; i < map->count; i++) {
        map->records[i].fitted = T3R_EARLIER_PIECE;
    }
}

void t3r_map_place(t3r_map *map, uint32_t i, const int64_t position_q20[3], uint32_t *kept)
{
    if (in_range(position_q20)) {
        for (int k = 0; k < 3; k++) {
            map->gaussians[i].position_q20[k] = (int32_t)position_q20[k];
        }
        move_to(map, i, (*kept)++);
    }
}

void t3r_map_move(t3r_map *map, const int64_t by_q20[3])
{
    uint32_t kept = 0;
    for (uint32_t i = 0; i < map->count; i++) {
        const int32_t *p_q20 = map->gaussians[i].position_q20;
        t3r_map_place(map, i, (const int64_t[3]){p_q20[0] + by_q20[0], p_q20[1] + by_q20[1], p_q20[2] + by_q20[2]},
                      &kept);
    }
    map->count = kept;
}
