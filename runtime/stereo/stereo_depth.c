/* SPDX-License-Identifier: Apache-2.0 */
#include "stereo_depth.h"

#include "core/fixed.h"
#include "match.h"
#include "stereo.h"

#define FAR_STEPS 60000
#define STEPS_MOST (1u << 22)
/* Pictures of different places match with confidence at 2 or 3 % of their pixels, by chance: below 1/25 nothing
 * matches. */
#define LEAST_SHARE 25
/* 1/TOO_FAR of the matched pixels may be too far for the depth unit. */
#define TOO_FAR 64
/* The unit is chosen from every second pixel of every second row, by eighths of octaves of baselines in Q16. */
#define SAMPLING 2
#define BINS 384
/* Bins above the median: distances beyond 64 times the median are not resolved. */
#define FARTHEST 48
/* A pixel with less parallax has no known distance. */
#define NO_PARALLAX_Q16 32768

/* Distance of a view's pixel along z, in baselines: numerator / denominator. */
typedef struct distance {
    int64_t numerator_q24, denominator_q30; /* both positive */
    int32_t disparity_q16;                  /* pixels from where infinity is */
    uint8_t confidence;                     /* T3R_STEREO_... */
} distance;

_Static_assert(T3R_STEREO_FILLED == 1 && T3R_STEREO_LEAST == 2, "kernels/disparity_at.h says so, too");

/* Pixels of a view's row, seen in the planes. */
typedef struct sight {
    t3r_ray_places places;
    t3r_disparities found;
} sight;

static void look_at(const t3r_kernels *kernels, const t3r_stereo_planes *planes, uint32_t side,
                    const t3r_view_columns *columns, uint32_t v, sight *seen)
{
    const t3r_disparity_plane plane = {.disparity = planes->disparity[side],
                                       .confidence = planes->confidence[side],
                                       .width = planes->columns[side],
                                       .height = planes->rect->height,
                                       .begin_q16 = planes->begin_q16[side],
                                       .first = planes->first,
                                       .right = side != 0,
                                       .filled = planes->filled,
                                       .scale = planes->rect->column_scale};
    t3r_rectified_places(kernels, planes->rect, side, columns, v, &seen->places);
    kernels->disparity_at(&plane, &seen->places, columns->count, &seen->found);
}

/* Measures the distance of sample i; false: it has none. */
static bool see(bool polar, uint32_t side, const sight *seen, uint32_t i, distance *s)
{
    s->confidence = (uint8_t)seen->found.confidence[i];
    if (s->confidence == T3R_STEREO_NONE) {
        return false;
    }
    const int32_t across_q24 = seen->places.z_q24[i];
    const t3r_column own = t3r_column_of(polar, seen->found.own_q24[i]);
    const t3r_column other = t3r_column_of(polar, seen->found.other_q24[i]);
    const t3r_column *first = side == 0 ? &own : &other, *second = side == 0 ? &other : &own;
    if (other.b_q24 <= 0) { /* its own place is nearer than that, or it is nowhere */
        return false;
    }
    s->disparity_q16 = seen->found.disparity_q16[i];
    /* |a| <= 2^27, b <= 2^24: the difference of the cotangents times both b, Q48 to Q30 */
    int64_t apart_q30 =
        t3r_round_shift64((int64_t)first->a_q24 * second->b_q24 - (int64_t)second->a_q24 * first->b_q24, 18);
    apart_q30 = T3R_MAX(apart_q30, 1); /* at and beyond infinity: as far as can be */
    s->numerator_q24 = t3r_round_shift64((int64_t)own.b_q24 * other.b_q24, 24);
    s->denominator_q30 = T3R_MAX(t3r_round_shift64(apart_q30 * across_q24, 24), 1); /* 2^33 x 2^28.6 */
    return true;
}

/* Statistics of every second pixel of every second row. */
typedef struct sample {
    uint32_t pixels, matched, still; /* matched: surely; still: of these, without parallax */
    uint32_t histogram[BINS];        /* the others, by how far they are */
} sample;

static void count_distance(const distance *s, sample *seen)
{
    if (s->confidence < T3R_STEREO_SURE) {
        return;
    }
    seen->matched++;
    if (s->disparity_q16 < NO_PARALLAX_Q16) {
        seen->still++;
        return;
    }
    const int64_t baselines_q16 = t3r_round_div64(s->numerator_q24 * (1 << 22), s->denominator_q30);
    seen->histogram[t3r_log2_wide_q16((uint64_t)T3R_MAX(baselines_q16, 1)) >> 13]++;
}

static void sample_columns(const t3r_kernels *kernels, const t3r_stereo_planes *planes, uint32_t side,
                           const t3r_view_columns *columns, uint32_t height, sample *all)
{
    for (uint32_t v = 0; v < height; v += SAMPLING) {
        sight seen;
        look_at(kernels, planes, side, columns, v, &seen);
        for (uint32_t i = 0; i < columns->count; i++) {
            distance s;
            if (see(planes->rect->polar, side, &seen, i, &s)) {
                count_distance(&s, all);
            }
        }
        all->pixels += columns->count;
    }
}

static void sample_view(const t3r_kernels *kernels, const t3r_stereo_planes *planes, uint32_t side,
                        const t3r_view *view, sample *all)
{
    const uint32_t across = (view->width + SAMPLING - 1) / SAMPLING;
    for (uint32_t first = 0; first < across; first += T3R_RAYS) {
        t3r_view_columns columns;
        t3r_view_columns_of(planes->rect, side, SAMPLING * first, SAMPLING, T3R_MIN(across - first, T3R_RAYS),
                            &columns);
        sample_columns(kernels, planes, side, &columns, view->height, all);
    }
}

/* Returns what the pair is good for. */
static t3r_pair judge(const sample *seen)
{
    const uint32_t least = seen->pixels / LEAST_SHARE;
    if (seen->matched < least) {
        return T3R_PAIR_OVERLAP;
    }
    if (4 * (uint64_t)seen->still > 3 * (uint64_t)seen->matched) {
        return T3R_PAIR_PARALLAX;
    }
    return seen->matched - seen->still < least ? T3R_PAIR_OVERLAP : T3R_PAIR_OK;
}

/* Returns the bin of the far percentile, at most FARTHEST bins beyond that of the median. */
static int32_t far_bin(const sample *seen)
{
    const uint32_t moving = seen->matched - seen->still;
    int32_t far = BINS - 1, median = 0;
    for (uint32_t beyond = seen->histogram[far]; far > 0 && beyond <= moving / TOO_FAR;) {
        beyond += seen->histogram[--far];
    }
    for (uint32_t below = seen->histogram[0]; median < far && 2 * below <= moving;) {
        below += seen->histogram[++median];
    }
    return T3R_MIN(far, median + FARTHEST);
}

/* Returns the steps of a baseline with which a bin's end, 2^((bin + 1) / 8 - 16) baselines, is FAR_STEPS away. */
static uint32_t steps_of(int32_t bin)
{
    const int32_t shift = (bin + 1) / 8, part = (bin + 1) % 8;
    const int64_t limit_q16 = t3r_scale64(t3r_exp2_q16(part << 13), shift - 16);
    return (uint32_t)t3r_clamp64(t3r_round_div64((int64_t)FAR_STEPS << 16, T3R_MAX(limit_q16, 1)), 1, STEPS_MOST);
}

/* Returns baseline / steps in Q40, 0 where no depth unit is so small or so large. */
static uint64_t unit_of(const t3r_rectification *rect, uint32_t steps)
{
    const int64_t unit = t3r_round_div64((int64_t)rect->baseline_q31 << 24, steps);
    const int32_t scale = rect->baseline_exponent - 31 - 24 + 8; /* unit below 2^57 */
    if (scale > 0 && (scale > 47 || unit >> (47 - scale) != 0)) {
        return 0;
    }
    const int64_t unit_q40 = t3r_scale64(unit, scale);
    return unit_q40 < 1 || unit_q40 >= INT64_C(1) << 47 ? 0 : (uint64_t)unit_q40;
}

t3r_pair t3r_stereo_unit(const t3r_kernels *kernels, t3r_stereo_planes *planes, const t3r_view views[2],
                         uint64_t *depth_unit_q40)
{
    sample seen = {0};
    for (uint32_t side = 0; side < 2; side++) {
        sample_view(kernels, planes, side, &views[side], &seen);
    }
    const t3r_pair pair = judge(&seen);
    if (pair != T3R_PAIR_OK) {
        return pair;
    }
    planes->steps = steps_of(far_bin(&seen));
    const uint64_t unit_q40 = unit_of(planes->rect, planes->steps);
    if (unit_q40 == 0) {
        return T3R_PAIR_SCALE;
    }
    *depth_unit_q40 = unit_q40;
    return T3R_PAIR_OK;
}

typedef struct view_job {
    const t3r_kernels *kernels;
    const t3r_stereo_planes *planes;
    uint32_t side;
    const t3r_view *view;
} view_job;

static void set_depth(const t3r_view *view, size_t at, const distance *s, uint32_t steps)
{
    const int64_t depth = t3r_round_div64(s->numerator_q24 * steps * 64, s->denominator_q30); /* 2^22 x 2^25 x 2^6 */
    const bool known = depth <= UINT16_MAX && s->disparity_q16 >= NO_PARALLAX_Q16;
    view->depth[at] = (uint16_t)t3r_clamp64(depth, 1, UINT16_MAX);
    view->match_confidence[at] = known ? s->confidence : T3R_STEREO_FILLED;
}

/* Sets the depth of a part of row v, whose first pixel is `at`. */
static void view_part(const view_job *job, const t3r_view_columns *columns, size_t at, uint32_t v)
{
    const t3r_view view = *job->view; /* a copy: writing its bytes changes none of what it holds */
    const uint32_t side = job->side, steps = job->planes->steps;
    const bool polar = job->planes->rect->polar;
    sight seen;
    look_at(job->kernels, job->planes, side, columns, v, &seen);
    for (uint32_t i = 0; i < columns->count; i++, at++) {
        distance s;
        const bool shown = (view.colour[0][at] | view.colour[1][at] | view.colour[2][at]) != 0;
        if (shown && see(polar, side, &seen, i, &s)) {
            set_depth(&view, at, &s, steps);
        } else {
            view.depth[at] = 0;
            view.match_confidence[at] = T3R_STEREO_NONE;
        }
    }
}

static void view_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const view_job *job = context;
    const uint32_t width = job->view->width;
    for (uint32_t first = 0; first < width; first += T3R_RAYS) {
        t3r_view_columns columns;
        t3r_view_columns_of(job->planes->rect, job->side, first, 1, T3R_MIN(width - first, T3R_RAYS), &columns);
        for (uint32_t v = begin; v < end; v++) {
            view_part(job, &columns, (size_t)v * width + first, v);
        }
    }
}

void t3r_stereo_to_view(const t3r_kernels *kernels, const t3r_stereo_planes *planes, uint32_t side,
                        const t3r_view *view, const t3r_workers *workers)
{
    view_job job = {kernels, planes, side, view};
    t3r_run_rows(workers, view->height, view_rows, &job);
}
