/* SPDX-License-Identifier: Apache-2.0 */
/* Corrects the poses of context views until the views agree: Gauss-Newton steps on the colour and depth of shared
 * surfaces, from coarse pictures to fine ones (Lucas and Kanade, "An iterative image registration technique", 1981;
 * Kerl, Sturm and Cremers, "Robust odometry estimation for RGB-D cameras", 2013). */
#include "align.h"

#include "align_solve.h"
#include "core/camera.h"
#include "core/fixed.h"
#include "core/memory.h"
#include "misalignment.h"
#include "pointmap_work.h"

#define COARSEST_SIDE 32u
#define PAIR_LEAST 64u      /* compared pixels; a pair with fewer is ignored */
#define STILL_Q30 (1 << 17) /* at level 0: a level ends after shorter steps */
#define CLIPPED 32u         /* levels: larger differences count as this much */
#define GUESSES 3           /* times that an aligned pose becomes the guess */

/* How far a view may be from its first pose. */
typedef struct freedom {
    uint32_t prior_shift; /* twice -log2 of the expected error: radians, and median depths */
    int32_t most_q30;     /* bound of a deviation: radians, and scene units */
    uint32_t halves;      /* log2: the part of a step that is taken */
    uint32_t pixels;      /* log2: compared pixels, as a multiple of t3r_align_pixels() */
} freedom;

/* Poses that were given, of views that all move. */
static const freedom all_given = {.prior_shift = 10, .most_q30 = 1 << 26, .halves = 1, .pixels = 0};
/* A pose that was guessed, among views that stay. */
static const freedom one_guessed = {.prior_shift = 8, .most_q30 = 1 << 28, .halves = 0, .pixels = 3};

typedef struct alignment {
    t3r_runtime *rt;
    t3r_view *views;
    uint32_t count;
    uint32_t first, end; /* the views that move */
    freedom freedom;
    uint32_t stride[T3R_MAX_VIEWS]; /* stride of the compared pixels of a view, in columns and rows */
    uint32_t step, steps;           /* for progress: done and total */
    t3r_pointmap_work work;
    t3r_aligned_view aligned[T3R_MAX_VIEWS];
    t3r_pair_levels levels[T3R_MAX_VIEWS][T3R_MAX_VIEWS];
    t3r_align_sums sums[T3R_MAX_VIEWS];
} alignment;

/* Difference between the views, summed over all pairs. */
typedef struct difference {
    uint64_t levels;
    uint32_t pixels;
} difference;

/* Turns q by a small rotation vector in the axes of the scene. Components below 1.5 change by less than a tenth. */
static void turn(const int32_t q[4], const int32_t by_q30[3], int32_t out[4])
{
    const int64_t x = by_q30[0], y = by_q30[1], z = by_q30[2];
    out[0] = q[0] - (int32_t)t3r_round_shift64(x * q[1] + y * q[2] + z * q[3], 31);
    out[1] = q[1] + (int32_t)t3r_round_shift64(x * q[0] + y * q[3] - z * q[2], 31);
    out[2] = q[2] + (int32_t)t3r_round_shift64(y * q[0] + z * q[1] - x * q[3], 31);
    out[3] = q[3] + (int32_t)t3r_round_shift64(z * q[0] + x * q[2] - y * q[1], 31);
}

/* Sets the camera and the view's pose from the given pose and its deviation. Returns false where they are out of
 * range. */
static bool place(const alignment *a, uint32_t v)
{
    t3r_runtime *rt = a->rt;
    const int32_t *deviation_q30 = rt->deviation_q30[v];
    t3r_camera *camera = &rt->camera[v];
    turn(rt->given[v].rotation_q30, deviation_q30, camera->rotation_q30);
    for (int i = 0; i < 3; i++) { /* scene units in Q30 are 2^(2 + exponent) world units in Q32 */
        camera->position_q32[i] =
            rt->given[v].position_q32[i] + t3r_scale64(deviation_q30[3 + i], 2 + rt->frame.exponent);
    }
    return t3r_camera_check(camera, rt->config.width, rt->config.height) == T3R_OK &&
           t3r_pose_in_scene(camera, &rt->frame, &a->views[v].pose) == T3R_OK;
}

static void place_as_given(const alignment *a, uint32_t v)
{
    t3r_pose_as_given(a->rt, v);
    (void)t3r_pose_in_scene(&a->rt->camera[v], &a->rt->frame, &a->views[v].pose); /* it was in range before */
}

/* Averages green pixels over blocks of 2^level x 2^level. Pixels outside whole blocks are omitted. */
static void shrink(const t3r_view *view, uint32_t level, uint8_t *out)
{
    const uint32_t side = 1u << level, width = view->width >> level, height = view->height >> level;
    for (uint32_t y = 0; y < height; y++) {
        for (uint32_t x = 0; x < width; x++) {
            const uint8_t *from = view->colour[1] + (size_t)(y << level) * view->width + (x << level);
            uint32_t sum = side * side / 2;
            for (uint32_t j = 0; j < side; j++) {
                for (uint32_t i = 0; i < side; i++) {
                    sum += from[j * (size_t)view->width + i];
                }
            }
            out[(size_t)y * width + x] = (uint8_t)(sum >> (2 * level));
        }
    }
}

/* Sets the pictures of a level. Level 1 of 16 views fits the work memory exactly; coarser levels take less. */
static void show_level(alignment *a, uint32_t level)
{
    uint8_t *room = (uint8_t *)a->work.pixels;
    for (uint32_t v = 0; v < a->count; v++) {
        const t3r_view *view = &a->views[v];
        const uint32_t width = view->width >> level, height = view->height >> level;
        const uint8_t *pixels = view->colour[1];
        if (level > 0) {
            shrink(view, level, room);
            pixels = room;
            room += (size_t)width * height;
        }
        a->aligned[v] =
            (t3r_aligned_view){t3r_pointmap_of(view, a->rt->frame.exponent), {pixels, width, height, level}};
    }
}

/* Returns the stride of compared columns and rows, at least 2. */
static uint32_t stride_of(const t3r_view *view, uint32_t most)
{
    const uint32_t pixels = view->width * view->height;
    uint32_t reliable = 0, stride = 2;
    for (uint32_t i = 0; i < pixels; i++) {
        reliable += t3r_is_reliable(view->validity[i]);
    }
    while (T3R_MAX(reliable, pixels / 4) > most * stride * stride) {
        stride++;
    }
    return stride;
}

static uint32_t coarsest_level(const t3r_view *view)
{
    uint32_t level = 0;
    while (level + 1 < T3R_ALIGN_LEVELS && T3R_MIN(view->width, view->height) >> (level + 1) >= COARSEST_SIDE) {
        level++;
    }
    return level;
}

static bool moves(const alignment *a, uint32_t v)
{
    return v >= a->first && v < a->end;
}

/* Compares all views with all others, if one of both moves: computes the sums of each view and the levels of each pair.
 */
static t3r_status compare(alignment *a, difference *all)
{
    uint32_t *bins = a->work.ratios[0];
    _Static_assert(T3R_ALIGN_BINS <= T3R_RATIO_BINS, "a histogram of differences is lent one of ratios");
    if (!t3r_progress(a->rt, T3R_STAGE_POINTMAP, a->step++, a->steps)) {
        return T3R_ERR_CANCELLED;
    }
    memset(a->sums, 0, sizeof a->sums);
    *all = (difference){0};
    for (uint32_t from = 0; from < a->count; from++) {
        for (uint32_t to = 0; to < a->count; to++) {
            if (from == to || !(moves(a, from) || moves(a, to))) {
                continue;
            }
            memset(bins, 0, T3R_ALIGN_BINS * sizeof *bins);
            const uint32_t pixels = t3r_compare_pair(&a->aligned[from], &a->aligned[to], a->stride[from],
                                                     &a->levels[from][to], bins, &a->sums[from], &a->sums[to]);
            t3r_pair_levels *levels = &a->levels[from][to];
            if (pixels < PAIR_LEAST) {
                *levels = (t3r_pair_levels){0};
                continue;
            }
            *levels = t3r_levels_of(bins, pixels);
            for (uint32_t i = 0; i < T3R_ALIGN_BINS; i++) {
                const int32_t off = (int32_t)i - (int32_t)T3R_ALIGN_BINS / 2 - levels->middle;
                all->levels += bins[i] * (uint64_t)T3R_MIN((uint32_t)t3r_abs32(off), CLIPPED);
            }
            all->pixels += pixels;
        }
    }
    return T3R_OK;
}

/* Takes one view's Gauss-Newton step, or half of it if both views of a pair move. The first pose counts as a
 * measurement: a deviation of the expected size costs as much as all differences do now. Returns the largest component
 * of the whole step. */
static int32_t step(alignment *a, uint32_t v)
{
    t3r_align_sums *sums = &a->sums[v];
    const int64_t median_q20 = a->rt->median_depth_q20;
    const int64_t of_turn = t3r_scale64(sums->squares_q8, (int32_t)a->freedom.prior_shift - 8);
    const int64_t of_shift = (of_turn << 14) / ((median_q20 * median_q20) >> 26); /* at most 2^45 before */
    int64_t b_q4[T3R_ALIGN_UNKNOWNS];
    int32_t x_q30[T3R_ALIGN_UNKNOWNS], largest_q30 = 0;
    for (uint32_t i = 0, at = 0; i < T3R_ALIGN_UNKNOWNS; at += T3R_ALIGN_UNKNOWNS - i++) {
        const int64_t prior = i < 3 ? of_turn : of_shift;
        sums->products[at] += prior + 1;
        b_q4[i] =
            -sums->gradient_q4[i] - t3r_round_shift64(t3r_round_shift64(prior, 15) * a->rt->deviation_q30[v][i], 11);
    }
    t3r_align_solve(sums->products, b_q4, x_q30);
    for (uint32_t i = 0; i < T3R_ALIGN_UNKNOWNS; i++) {
        int32_t *deviation_q30 = &a->rt->deviation_q30[v][i];
        *deviation_q30 = t3r_clamp32(*deviation_q30 + t3r_round_shift32(x_q30[i], a->freedom.halves),
                                     -a->freedom.most_q30, a->freedom.most_q30);
        largest_q30 = T3R_MAX(largest_q30, t3r_abs32(x_q30[i]));
    }
    return largest_q30;
}

/* Takes a step of all moving views at once. Returns the largest component of any step. */
static int32_t step_all(alignment *a)
{
    int32_t largest_q30 = 0;
    for (uint32_t v = a->first; v < a->end; v++) {
        largest_q30 = T3R_MAX(largest_q30, step(a, v));
    }
    for (uint32_t v = a->first; v < a->end; v++) {
        if (!place(a, v)) {
            place_as_given(a, v);
        }
    }
    return largest_q30;
}

/* Measures the difference with the current poses at the finest level. */
static t3r_status measure(alignment *a, difference *all)
{
    memset(a->levels, 0, sizeof a->levels);
    show_level(a, 0);
    return compare(a, all);
}

static t3r_status align_level(alignment *a, uint32_t level)
{
    memset(a->levels, 0, sizeof a->levels);
    show_level(a, level);
    for (uint32_t round = 0; round < T3R_ALIGN_ROUNDS; round++) {
        difference all;
        const t3r_status status = compare(a, &all);
        if (status != T3R_OK) {
            return status;
        }
        if (round > 0 && step_all(a) < STILL_Q30 << level) {
            break;
        }
    }
    return T3R_OK;
}

/* Whether the views differ by at least a 16th less than before, with at least 3/4 of the pixels compared. */
static bool is_better(const difference *before, const difference *behind)
{
    return 4 * (uint64_t)behind->pixels >= 3 * (uint64_t)before->pixels &&
           16 * behind->levels * before->pixels <= 15 * before->levels * behind->pixels && before->levels > 0;
}

/* Prepares what follows from the runtime and its views. */
static void prepare(alignment *a)
{
    a->count = a->rt->views;
    a->work = t3r_pointmap_work_of(a->rt);
    for (uint32_t v = 0; v < a->count; v++) {
        a->stride[v] = stride_of(&a->views[v], t3r_align_pixels(a->count) << a->freedom.pixels);
    }
}

static t3r_status align_levels(alignment *a)
{
    const uint32_t coarsest = coarsest_level(&a->views[0]);
    t3r_status status = T3R_OK;
    for (uint32_t level = coarsest + 1; level-- > 0 && status == T3R_OK;) {
        a->step = 1 + (coarsest - level) * T3R_ALIGN_ROUNDS; /* a level may have ended early */
        status = align_level(a, level);
    }
    return status;
}

t3r_status t3r_align_view(t3r_runtime *rt, t3r_view *views, uint32_t v)
{
    alignment a = {
        .rt = rt, .views = views, .first = v, .end = v + 1, .freedom = one_guessed, .steps = T3R_ALIGN_STEPS};
    prepare(&a);
    t3r_status status = align_levels(&a);
    for (int i = 0; i < GUESSES && status == T3R_OK; i++) { /* the guess pulls the pose: guess again */
        t3r_note_placement(&rt->given[v], &rt->camera[v]);
        memset(rt->deviation_q30[v], 0, sizeof rt->deviation_q30[v]);
        a.step = T3R_ALIGN_STEPS - T3R_ALIGN_ROUNDS;
        status = align_level(&a, 0);
    }
    return status;
}

t3r_status t3r_align_views(t3r_runtime *rt, t3r_view *views, uint32_t steps)
{
    alignment a = {.rt = rt, .views = views, .end = rt->views, .freedom = all_given, .steps = steps};
    difference before, behind;
    prepare(&a);
    t3r_status status = measure(&a, &before);
    if (status == T3R_OK && before.pixels > 0) {
        status = align_levels(&a);
    }
    if (status == T3R_OK) {
        a.step = T3R_ALIGN_STEPS - 1;
        status = measure(&a, &behind);
    }
    if (status == T3R_OK && !is_better(&before, &behind)) {
        for (uint32_t v = 0; v < rt->views; v++) {
            place_as_given(&a, v);
        }
    }
    return status;
}
