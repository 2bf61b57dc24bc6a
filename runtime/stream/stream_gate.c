/* SPDX-License-Identifier: Apache-2.0 */
#include "stream_gate.h"

#include "core/memory.h"
#include "pointmap/contradiction.h"
#include "pointmap/pointmap_work.h"
#include "stream_map.h"

#define SAMPLES_MOST 4096u /* Gaussians compared */
#define GAUSSIANS_LEAST 32 /* fewer say nothing */
#define LEVEL_LEAST 16
#define LEVEL_MOST 239
#define DETAIL_REACH 4 /* pixels: distance of the coarse differences */

/* --- the picture alone ------------------------------------------------------------------------------------------ */

static uint32_t share_q8(uint32_t part, uint32_t whole)
{
    return whole == 0 ? 0 : (uint32_t)((uint64_t)part * 256 / whole);
}

static int32_t luma_of(const t3r_view *view, size_t pixel)
{
    return (view->colour[0][pixel] + 2 * view->colour[1][pixel] + view->colour[2][pixel]) / 4;
}

static void measure_levels(const t3r_view *view, t3r_stream_report *report)
{
    const size_t pixels = (size_t)view->width * view->height;
    uint32_t dark = 0, bright = 0, measured = 0;
    for (size_t i = 0; i < pixels; i++) {
        const int32_t luma = luma_of(view, i);
        dark += luma < LEVEL_LEAST;
        bright += luma > LEVEL_MOST;
        measured += t3r_is_measured(view->validity[i]);
    }
    report->depth_q8 = share_q8(measured, (uint32_t)pixels);
    report->dark_q8 = share_q8(dark, (uint32_t)pixels);
    report->bright_q8 = share_q8(bright, (uint32_t)pixels);
}

/* Measures the squared differences of neighbours over those of pixels DETAIL_REACH apart. A blurred picture has few of
 * the former; how much texture it has hardly matters. A row has fewer than 2^12 pixels: sums stay below 2^40. */
static void measure_detail(const t3r_view *view, t3r_stream_report *report)
{
    uint64_t fine = 0, coarse = 0;
    for (uint32_t y = 0; y < view->height; y += 2) {
        const uint8_t *row = view->colour[1] + (size_t)y * view->width;
        for (uint32_t x = 0; x + DETAIL_REACH < view->width; x++) {
            const int32_t near = row[x + 1] - row[x], far = row[x + DETAIL_REACH] - row[x];
            fine += (uint32_t)(near * near);
            coarse += (uint32_t)(far * far);
        }
    }
    report->detail_q8 = coarse == 0 ? 0 : (uint32_t)T3R_MIN(fine * 256 / coarse, (uint64_t)1024);
}

/* --- the picture and the map ------------------------------------------------------------------------------------ */

/* Sums of the lumas of Gaussians, x, and of their pixels, y. At most 2^12 pairs: each product of sums is below
 * 2^40. */
typedef struct likeness {
    int64_t count, x, y, xx, yy, xy;
} likeness;

static void add_pair(likeness *l, int32_t x, int32_t y)
{
    l->count++;
    l->x += x;
    l->y += y;
    l->xx += x * x;
    l->yy += y * y;
    l->xy += x * y;
}

/* Returns the correlation, 0..256; 256 if there are few pairs, or the Gaussians differ by less than 8 levels. */
static uint32_t correlation_q8(const likeness *l)
{
    const int64_t of_x = l->count * l->xx - l->x * l->x, of_y = l->count * l->yy - l->y * l->y;
    if (l->count < GAUSSIANS_LEAST || of_x < 64 * l->count * l->count) {
        return 256;
    }
    const int64_t roots = (int64_t)t3r_isqrt64((uint64_t)of_x) * t3r_isqrt64((uint64_t)of_y);
    const int64_t both = l->count * l->xy - l->x * l->y;
    return roots == 0 ? 0 : (uint32_t)t3r_clamp64(both * 256 / roots, 0, 256);
}

typedef struct comparison {
    uint32_t agreeing, contradicted; /* Gaussians on the frame's surface; that it sees through */
    uint32_t levelled;               /* well exposed ones of them */
    uint32_t seen_last, recent;      /* seen by the last keyframe; of these in the picture */
    uint32_t hidden;                 /* of these behind something near, or without a depth */
    likeness shown, covered;         /* colours of the agreeing ones that are not clipped, and of the hidden ones */
} comparison;

/* Counts the log ratio of the pixel's green to that of a well exposed Gaussian. */
static void count_ratio(uint32_t level, uint32_t green_q7, uint32_t bins[T3R_RATIO_BINS], uint32_t *levelled)
{
    if (green_q7 >= LEVEL_LEAST * 128 && green_q7 <= LEVEL_MOST * 128) {
        const uint32_t level_q7 = T3R_MAX(level * 128, 64u);
        const int32_t ratio_q6 = t3r_round_shift32(t3r_log2_q16(level_q7) - t3r_log2_q16(green_q7), 10);
        bins[t3r_clamp32(ratio_q6 + T3R_RATIO_BINS / 2, 0, T3R_RATIO_BINS - 1)]++;
        ++*levelled;
    }
}

/* Returns the least ratio that at least half of the pairs don't exceed, log2 in Q8; 0 without pairs. */
static int32_t median_q8(const uint32_t bins[T3R_RATIO_BINS], uint32_t count)
{
    uint32_t sum = 0;
    int32_t at = count == 0 ? T3R_RATIO_BINS / 2 : 0;
    while (at < T3R_RATIO_BINS - 1 && 2 * (sum + bins[at]) < count) {
        sum += bins[at++];
    }
    return (at - T3R_RATIO_BINS / 2) * 4;
}

static void compare_gaussian(const t3r_pointmap *frame, const t3r_gaussian *g, const t3r_map_record *record,
                             uint32_t bins[T3R_RATIO_BINS], comparison *all)
{
    const t3r_view *view = frame->view;
    const bool recent = record->idle == 0;
    t3r_projected_pixel at;
    all->seen_last += recent;
    if (!t3r_project_to_pixel(view, g->position_q20, &at)) {
        return;
    }
    const int32_t luma = (g->colour_q7[0] + 2 * g->colour_q7[1] + g->colour_q7[2]) / 512;
    const bool measured = t3r_is_measured(view->validity[at.pixel]);
    const int32_t surface_q20 = t3r_depth_q20(frame->scale, view->depth[at.pixel]);
    all->recent += recent;
    if (measured && t3r_is_one_surface(surface_q20, at.z_q20, 16)) {
        all->agreeing++;
        if (luma <= LEVEL_MOST && luma_of(view, at.pixel) <= LEVEL_MOST) { /* clipped colours correlate with nothing */
            add_pair(&all->shown, luma, luma_of(view, at.pixel));
        }
        count_ratio(view->colour[1][at.pixel], g->colour_q7[1], bins, &all->levelled);
    } else if (t3r_seen_through(frame, &at, false)) {
        all->contradicted++;
    } else if (recent && (!measured || surface_q20 < at.z_q20 / 4)) {
        all->hidden++;
        /* what is near cannot show the Gaussian: its colour says nothing */
        add_pair(&all->covered, luma, measured ? 0 : luma_of(view, at.pixel));
    }
}

static void compare_with_map(const t3r_runtime *rt, const t3r_view *view, t3r_stream_report *report)
{
    const t3r_map map = t3r_map_of(rt);
    const t3r_pointmap frame = t3r_pointmap_of(view, rt->frame.exponent);
    const uint32_t step = (map.count + SAMPLES_MOST - 1) / SAMPLES_MOST;
    uint32_t *bins = t3r_pointmap_work_of(rt).ratios[0];
    comparison all = {0};
    memset(bins, 0, T3R_RATIO_BINS * sizeof *bins);
    for (uint32_t i = 0; i < map.count; i += step) {
        compare_gaussian(&frame, &map.gaussians[i], &map.records[i], bins, &all);
    }
    report->compared = all.agreeing + all.contradicted;
    report->contradicted_q8 = share_q8(all.contradicted, report->compared);
    report->likeness_q8 = correlation_q8(&all.shown);
    report->recent = all.recent;
    report->in_view_q8 = share_q8(all.recent, all.seen_last);
    report->hidden_q8 = share_q8(all.hidden, all.recent);
    report->hidden_likeness_q8 = correlation_q8(&all.covered);
    report->exposure_q8 = median_q8(bins, all.levelled);
}

void t3r_gate_measure(const t3r_runtime *rt, const t3r_view *view, t3r_stream_report *report)
{
    measure_levels(view, report);
    measure_detail(view, report);
    report->likeness_q8 = report->hidden_likeness_q8 = 256;
    if (rt->keyframes > 0) {
        compare_with_map(rt, view, report);
    }
}

/* --- the decision ----------------------------------------------------------------------------------------------- */

/* Chosen on the training scenes with depth and on the built-in room. */
#define LEAST_DEPTH_Q8 4u      /* 1/64 of the pixels */
#define UNLIT_Q8 240u          /* 15/16 of the pixels are too dark, or too bright */
#define HIDDEN_Q8 160u         /* 5/8 of what the last keyframe saw */
#define HIDDEN_LIKENESS_Q8 80u /* 5/16 */
#define IN_VIEW_Q8 128u        /* half of it */
#define DISAGREEMENT_Q8 244u   /* good poses: at most 209; 0.7 m off: at least 279 */
#define EXPOSURE_MOST_Q8 256   /* an octave either way, as far as gains reach */

#define STEP_MOST_Q20 (1 << 19) /* half a scene unit along each axis, from frame to frame */

#define JUMP_AFTER 2u /* frames in a row that contradict the map along one path, before the map may move */

/* Frames in a row that are refused for a reason that may last, before one is taken all the same; 0 = for ever. */
static const uint8_t patience[T3R_REFUSAL_COUNT] = {
    [T3R_REFUSAL_EXPOSURE] = 16,
    [T3R_REFUSAL_BLURRED] = 4,
    [T3R_REFUSAL_COVERED] = 32,
    [T3R_REFUSAL_CONTRADICTS] = 4,
};

static uint32_t disagreement_q8(const t3r_stream_report *f)
{
    return 4 * f->contradicted_q8 + 256 - f->likeness_q8;
}

static bool is_comparable(const t3r_stream_report *f)
{
    return f->compared >= GAUSSIANS_LEAST;
}

bool t3r_gate_contradicts(const t3r_stream_report *f)
{
    return is_comparable(f) && disagreement_q8(f) >= DISAGREEMENT_Q8;
}

/* Whether the frame should show most of what the last keyframe saw, but shows hardly any of it. */
static bool misses(const t3r_stream_report *f)
{
    return f->recent >= GAUSSIANS_LEAST && f->in_view_q8 >= IN_VIEW_Q8 && 8 * f->compared < f->recent;
}

bool t3r_gate_agrees(const t3r_stream_report *f, const t3r_stream_report *before)
{
    return is_comparable(f) && !misses(f) && disagreement_q8(f) < DISAGREEMENT_Q8 &&
           (misses(before) || 4 * disagreement_q8(f) <= 3 * disagreement_q8(before));
}

static t3r_refusal fault_of(const t3r_runtime *rt, const t3r_stream_report *f)
{
    return f->depth_q8 < LEAST_DEPTH_Q8 ? T3R_REFUSAL_NO_DEPTH
           : f->dark_q8 > UNLIT_Q8      ? T3R_REFUSAL_DARK
           : f->bright_q8 > UNLIT_Q8    ? T3R_REFUSAL_BRIGHT
           : f->recent >= GAUSSIANS_LEAST && f->hidden_q8 >= HIDDEN_Q8 && f->hidden_likeness_q8 < HIDDEN_LIKENESS_Q8
               ? T3R_REFUSAL_COVERED
           : t3r_gate_contradicts(f) || misses(f)                             ? T3R_REFUSAL_CONTRADICTS
           : is_comparable(f) && t3r_abs32(f->exposure_q8) > EXPOSURE_MOST_Q8 ? T3R_REFUSAL_EXPOSURE
           : 8 * f->detail_q8 < 3u * rt->gate.detail_q8                       ? T3R_REFUSAL_BLURRED
                                                                              : T3R_REFUSAL_NONE;
}

/* Whether the camera is near the frame refused last: frames of a new piece follow one path, wrong poses do not. */
static bool follows_refused(const t3r_runtime *rt, const t3r_view *view)
{
    bool near = true;
    for (int i = 0; i < 3; i++) {
        const int64_t step = (int64_t)view->pose.position_q20[i] - rt->gate.refused_at_q20[i];
        near = near && t3r_abs64(step) <= STEP_MOST_Q20;
    }
    return near;
}

bool t3r_gate_suspects_jump(const t3r_runtime *rt, const t3r_view *view, const t3r_stream_report *report)
{
    return rt->gate.refusal == T3R_REFUSAL_CONTRADICTS && rt->gate.refused >= JUMP_AFTER &&
           fault_of(rt, report) == T3R_REFUSAL_CONTRADICTS && follows_refused(rt, view);
}

t3r_refusal t3r_gate_decide(t3r_runtime *rt, const t3r_view *view, const t3r_camera *camera, t3r_stream_report *report)
{
    t3r_gate *gate = &rt->gate;
    const t3r_refusal fault = fault_of(rt, report);
    if (fault == T3R_REFUSAL_CONTRADICTS && gate->refused > 0 && !follows_refused(rt, view)) {
        gate->refused = 0;
    }
    const bool waited = patience[fault] > 0 && gate->refused >= patience[fault];
    report->moved = waited && fault == T3R_REFUSAL_CONTRADICTS;
    if (fault == T3R_REFUSAL_CONTRADICTS && gate->refusal != T3R_REFUSAL_CONTRADICTS) {
        t3r_note_placement(&gate->contradicts_from, camera);
    }
    gate->refusal = (uint8_t)fault;
    if (fault != T3R_REFUSAL_NONE && !waited) {
        gate->refused = (uint8_t)(gate->refused + (patience[fault] > 0)); /* at most its patience */
        memcpy(gate->refused_at_q20, view->pose.position_q20, sizeof gate->refused_at_q20);
        return fault;
    }
    gate->refused = 0;
    gate->detail_q8 = gate->detail_q8 == 0 || waited ? (uint16_t)report->detail_q8
                                                     : (uint16_t)((3u * gate->detail_q8 + report->detail_q8 + 2) / 4);
    return T3R_REFUSAL_NONE;
}
