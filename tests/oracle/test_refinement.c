/* SPDX-License-Identifier: Apache-2.0 */
/* The integer refinement, after one pass to the default number, against the float64 oracle on the same scene: two
 * views of a slanted surface with holes in its depth and a nearer surface before it. */
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "oracle/float64/oracle_refine.h"
#include "rgbd_frame.h"
#include "state/ablation.h"
#include "state/state.h"
#include "test.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE, VIEWS = 2, BUDGET = 2 * PIXELS / 8, PASSES = 4 };

static uint8_t rgb[VIEWS][PIXELS * 3], depth[VIEWS][PIXELS * 2], counts[VIEWS][PIXELS];
static t3r_camera camera[VIEWS];

static void make_views(void)
{
    for (uint32_t v = 0; v < VIEWS; v++) {
        camera[v] = plain_camera(SIDE, SIDE, SIDE);
        camera[v].position_q32[0] = (int64_t)v * 3 << 28; /* 0.19 to the right */
        for (uint32_t i = 0; i < PIXELS; i++) {
            double x = i % SIDE, y = (double)(i / SIDE), shade = 128 + 80 * sin((x + 6 * v) * 0.35) * cos(y * 0.21);
            int near = x > 20 && x < 40 && y > 24 && y < 48;
            rgb[v][3 * i] = (uint8_t)(near ? 230 : shade);
            rgb[v][3 * i + 1] = (uint8_t)(255 - shade);
            rgb[v][3 * i + 2] = (uint8_t)(near ? 20 : 60 + x);
            uint32_t steps = near ? 1200 : 2000 + (uint32_t)(8 * x + 3 * y);
            if ((i % SIDE) % 19 == 7 && (i / SIDE) % 5 < 3) {
                steps = 0;
            }
            counts[v][i] = steps != 0;
            depth[v][2 * i] = (uint8_t)steps;
            depth[v][2 * i + 1] = (uint8_t)(steps >> 8);
        }
    }
}

typedef struct splat_maker {
    const char *name;
    t3r_head head;
    t3r_ablation ablation;
} splat_maker;

static int stop_before_refinement(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user, (void)done, (void)total;
    return stage == T3R_STAGE_REFINE;
}

/* Reconstructs with `refine` passes; 0 leaves the Gaussians as the head makes them. */
static t3r_gaussian *reconstruct(uint32_t refine, const splat_maker *maker, t3r_scene *scene)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, BUDGET);
    config.clusters = 16;
    config.refine = refine > 0 ? refine : 1;
    config.fit_passes = config.align = 0;
    config.head = maker->head;
    config.fill_radius = config.bridge_radius = 0;
    config.flying = config.redundancy = config.exposure = config.rim = 0; /* refinement only */
    arena a = arena_of(&config, ARENA_AT_FULL);
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, a.bytes, a.count, &config), T3R_OK);
    assert_int_equal(t3r_set_ablation(rt, &maker->ablation), T3R_OK);
    for (uint32_t v = 0; v < VIEWS; v++) {
        t3r_frame frame = rgbd_frame(rgb[v], depth[v], SIDE, SIDE, MILLIMETRE_Q40);
        assert_int_equal(t3r_add_view(rt, &frame, &camera[v]), T3R_OK);
    }
    if (refine > 0) {
        assert_int_equal(t3r_reconstruct(rt, NULL, scene), T3R_OK);
    } else {
        assert_int_equal(t3r_set_hooks(rt, &(t3r_hooks){.progress = stop_before_refinement}), T3R_OK);
        assert_int_equal(t3r_reconstruct(rt, NULL, scene), T3R_ERR_CANCELLED);
        *scene =
            (t3r_scene){.frame = rt->frame, .gaussians = t3r_buffer_at(rt, T3R_BUFFER_SCENE), .count = rt->gaussians};
    }
    t3r_gaussian *copy = calloc(scene->count, sizeof *copy);
    assert_non_null(copy);
    memcpy(copy, scene->gaussians, scene->count * sizeof *copy);
    scene->gaussians = copy;
    arena_free(&a);
    return copy;
}

static double length_of(const double *v, int n)
{
    double sum = 0;
    for (int i = 0; i < n; i++) {
        sum += v[i] * v[i];
    }
    return sqrt(sum);
}

typedef struct difference {
    double colour, opacity, place, shape; /* levels; 1; position and shape relative to the factor's norm */
} difference;

static difference between(const oracle_gaussian *a, const oracle_gaussian *b)
{
    double place[3], shape[9], colour = 0;
    for (int i = 0; i < 9; i++) {
        shape[i] = a->factor[i] - b->factor[i];
    }
    for (int i = 0; i < 3; i++) {
        place[i] = a->position[i] - b->position[i];
        colour = fmax(colour, 255 * fabs(a->colour[i] - b->colour[i]));
    }
    double norm = length_of(b->factor, 9);
    return (difference){colour, fabs(a->opacity - b->opacity), length_of(place, 3) / norm, length_of(shape, 9) / norm};
}

/* For a splat that is nearly hidden, 16-bit weights and the cut at alpha 1/255 remove most of its sums and so decide
 * the step. Hence the mean error is bounded by a share of the Gaussians' mean change, and all but STRAYS Gaussians by
 * a bound below the largest step. Each pass starts from the previous result, so errors add up. */
#define STRAYS 2
static const double mean_share[PASSES] = {0.015, 0.0175, 0.021, 0.025};
static const difference most_off[PASSES] = {
    {4, 0.15, 0.06, 0.06}, {4, 0.3, 0.2, 0.15}, {8, 0.5, 0.3, 0.3}, {12, 0.5, 0.5, 0.5}};

static void check_pass(const splat_maker *maker, uint32_t passes, const oracle_gaussian *scene,
                       const oracle_gaussian *want, size_t count)
{
    t3r_scene refined;
    t3r_gaussian *after = reconstruct(passes, maker, &refined);
    assert_int_equal(refined.count, count);
    const double share = mean_share[passes - 1];
    const difference bound = most_off[passes - 1];
    difference most = {0}, mean = {0}, moved = {0};
    uint32_t strays = 0;
    for (size_t i = 0; i < count; i++) {
        oracle_gaussian got;
        oracle_from_t3r(&after[i], &got);
        difference d = between(&got, &want[i]), m = between(&want[i], &scene[i]);
        most = (difference){fmax(most.colour, d.colour), fmax(most.opacity, d.opacity), fmax(most.place, d.place),
                            fmax(most.shape, d.shape)};
        strays +=
            d.colour >= bound.colour || d.opacity >= bound.opacity || d.place >= bound.place || d.shape >= bound.shape;
        mean.colour += d.colour / (double)count;
        mean.opacity += d.opacity / (double)count;
        mean.place += d.place / (double)count;
        mean.shape += d.shape / (double)count;
        moved.colour += m.colour / (double)count;
        moved.opacity += m.opacity / (double)count;
        moved.place += m.place / (double)count;
        moved.shape += m.shape / (double)count;
    }
    print_message("%-8s %zu Gaussians, %u passes: moved %.2f %.4f %.4f %.4f, off by %.4f %.5f %.5f %.5f, at most %.3f "
                  "%.4f %.4f %.4f\n",
                  maker->name, count, passes, moved.colour, moved.opacity, moved.place, moved.shape, mean.colour,
                  mean.opacity, mean.place, mean.shape, most.colour, most.opacity, most.place, most.shape);
    assert_true(moved.colour > 1 && moved.opacity > 0.003 && moved.place > 0.01 && moved.shape > 0.01);
    assert_true(mean.colour < share * moved.colour);
    assert_true(mean.opacity < share * moved.opacity +
                                   0.001 * (passes - 1)); /* one pass may take opacity that the next one gives back */
    assert_true(mean.place < share * moved.place && mean.shape < share * moved.shape);
    assert_true(strays <= STRAYS);
    free(after);
}

TEST(follows_the_oracle)
{
    make_views();
    const splat_maker heads[] = {{"analytic", T3R_HEAD_ANALYTIC, {0}},
                                 {"unadapted", T3R_HEAD_ANALYTIC, {.unadapted = 1}}};
    for (size_t h = 0; h < sizeof heads / sizeof heads[0]; h++) {
        t3r_scene plain;
        t3r_gaussian *before = reconstruct(0, &heads[h], &plain);
        oracle_gaussian *scene = calloc(plain.count, sizeof *scene), *want = calloc(plain.count, sizeof *want);
        oracle_change *changes = calloc(plain.count, sizeof *changes);
        assert_true(scene != NULL && want != NULL && changes != NULL);
        oracle_context views[VIEWS];
        for (uint32_t v = 0; v < VIEWS; v++) {
            views[v] =
                (oracle_context){oracle_camera_from_t3r(&camera[v], &plain.frame, SIDE, SIDE), rgb[v], counts[v]};
        }
        for (uint32_t i = 0; i < plain.count; i++) {
            oracle_from_t3r(&before[i], &scene[i]);
            want[i] = scene[i];
        }
        for (uint32_t pass = 0; pass < PASSES; pass++) {
            oracle_refine(want, plain.count, views, VIEWS, changes);
            check_pass(&heads[h], pass + 1, scene, want, plain.count);
        }
        free(changes);
        free(want);
        free(scene);
        free(before);
    }
}
