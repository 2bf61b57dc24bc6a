/* SPDX-License-Identifier: Apache-2.0 */
/* The smallest sufficient scene: the budget is chosen in the arena, on two views of a textured wall with a box before
 * it. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "refine/refine.h"
#include "rgbd_frame.h"
#include "sanitized.h"
#include "sanitized_cpu.h"
#include "state/state.h"
#include "test.h"

enum { SIDE = 64, PIXELS = SIDE * SIDE, VIEWS = 2, HALF_DB = 128 };
static const t3r_request half_db = {.max_loss_q8 = HALF_DB};

static uint8_t rgb[VIEWS][PIXELS * 3], depth[VIEWS][PIXELS * 2];
static t3r_camera camera[VIEWS];

typedef struct site {
    arena memory;
    t3r_runtime *rt;
    int32_t calls_left; /* calls until the progress hook cancels; negative: never */
} site;

static int progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    site *s = user;
    (void)stage;
    (void)done;
    (void)total;
    return s->calls_left >= 0 && s->calls_left-- == 0;
}

/* contrast 0: everything has one colour */
static void make_views(double contrast)
{
    for (uint32_t v = 0; v < VIEWS; v++) {
        camera[v] = plain_camera(SIDE, SIDE, SIDE);
        camera[v].position_q32[0] = (int64_t)v << 30; /* 0.25 to the right: 8 pixels at depth 2 */
        for (uint32_t i = 0; i < PIXELS; i++) {
            double x = i % SIDE, y = (double)(i / SIDE), seen = x + 8 * v;
            bool near = contrast > 0 && seen > 24 && seen < 44 && y > 24 && y < 48;
            uint32_t steps = near ? 1900 : 2000;
            rgb[v][3 * i] = (uint8_t)(128 + contrast * sin(seen * 0.35) * cos(y * 0.21));
            rgb[v][3 * i + 1] = (uint8_t)(128 + contrast * sin(seen * 0.9 + y));
            rgb[v][3 * i + 2] = (uint8_t)(128 + (near ? contrast : 0));
            depth[v][2 * i] = (uint8_t)steps;
            depth[v][2 * i + 1] = (uint8_t)(steps >> 8);
        }
    }
}

static void add_views(site *s, uint32_t views)
{
    for (uint32_t v = 0; v < views; v++) {
        t3r_frame frame = rgbd_frame(rgb[v], depth[v], SIDE, SIDE, MILLIMETRE_Q40);
        assert_int_equal(t3r_add_view(s->rt, &frame, &camera[v]), T3R_OK);
    }
}

static site site_of(uint32_t most, uint32_t views)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, most);
    config.clusters = 20;
    config.cluster_batches = 24;
    config.keep_analysis = 1;
    config.exposure = 0;
    site s = {.memory = arena_of(&config, ARENA_AT_FULL), .calls_left = -1};
    assert_int_equal(t3r_init(&s.rt, s.memory.bytes, s.memory.count, &config), T3R_OK);
    vectors_if_sanitized(s.rt);
    add_views(&s, views);
    return s;
}

static t3r_scene within(site *s, uint32_t loss_q8)
{
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(s->rt, &(t3r_request){.max_loss_q8 = loss_q8}, &scene), T3R_OK);
    return scene;
}

/* The trials leave no trace: the scene equals one requested with that budget. */
TEST(the_scene_of_that_budget)
{
    make_views(90);
    for (uint32_t views = 1; views <= VIEWS; views++) {
        site chosen = site_of(VIEWS * PIXELS, views), asked = site_of(VIEWS * PIXELS, views);
        t3r_scene a = within(&chosen, HALF_DB), b;
        assert_true(a.count > 20 && a.count < views * PIXELS);
        assert_int_equal(chosen.rt->config.gaussians, VIEWS * PIXELS);
        assert_int_equal(t3r_reconstruct(asked.rt, NULL, &b), T3R_OK);
        assert_int_equal(t3r_rebuild(asked.rt, &(t3r_request){.gaussians = a.count}, &b), T3R_OK);
        assert_int_equal(a.count, b.count);
        assert_memory_equal(a.gaussians, b.gaussians, a.count * sizeof *a.gaussians);
        assert_int_equal(t3r_rebuild(asked.rt, &half_db, &b), T3R_OK);
        assert_int_equal(a.count, b.count);
        assert_memory_equal(a.gaussians, b.gaussians, a.count * sizeof *a.gaussians);
        arena_free(&chosen.memory);
        arena_free(&asked.memory);
    }
}

TEST(never_more_than_the_most)
{
    make_views(90);
    static const uint32_t most[] = {1, 2, 3, 10, 100};
    for (size_t i = 0; i < sizeof most / sizeof most[0]; i++) {
        site s = site_of(most[i], VIEWS);
        t3r_scene scene = within(&s, 1);
        assert_int_equal(scene.count, most[i]);
        arena_free(&s.memory);
    }
    site s = site_of(VIEWS * PIXELS, VIEWS);
    uint32_t before = UINT32_MAX;
    for (uint32_t loss_q8 = 16; loss_q8 <= T3R_MAX_LOSS_Q8; loss_q8 *= 2) {
        t3r_scene scene;
        if (s.rt->has_scene) {
            assert_int_equal(t3r_rebuild(s.rt, &(t3r_request){.max_loss_q8 = loss_q8}, &scene), T3R_OK);
        } else {
            scene = within(&s, loss_q8);
        }
        assert_true(scene.count <= before);
        before = scene.count;
    }
    assert_true(before < VIEWS * PIXELS / 20);
    arena_free(&s.memory);
}

/* Also with an importance: the scene equals one requested with that importance and budget. */
TEST(by_an_importance)
{
    make_views(90);
    static uint16_t importance[VIEWS][PIXELS];
    const uint16_t *const planes[VIEWS] = {importance[0], importance[1]};
    for (uint32_t i = 0; i < VIEWS * PIXELS; i++) {
        importance[i / PIXELS][i % PIXELS] = (uint16_t)(i * 40503);
    }
    t3r_request request = {.importance = planes, .importance_stride_bytes = 2 * SIDE, .max_loss_q8 = HALF_DB};
    site s = site_of(VIEWS * PIXELS, VIEWS);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(s.rt, &request, &scene), T3R_OK);
    const uint32_t chosen = scene.count;
    static t3r_gaussian kept[VIEWS * PIXELS];
    memcpy(kept, scene.gaussians, chosen * sizeof *kept);
    assert_true(chosen > 20 && chosen < VIEWS * PIXELS);
    assert_int_equal(t3r_rebuild(s.rt, &half_db, &scene), T3R_OK); /* by texture: other trials and another choice */
    assert_true(scene.count != chosen);
    request.max_loss_q8 = 0;
    request.gaussians = chosen;
    assert_int_equal(t3r_rebuild(s.rt, &request, &scene), T3R_OK);
    assert_int_equal(scene.count, chosen);
    assert_memory_equal(scene.gaussians, kept, chosen * sizeof *kept);
    request.max_loss_q8 = HALF_DB;
    request.gaussians = 0;
    assert_int_equal(t3r_rebuild(s.rt, &request, &scene), T3R_OK);
    assert_int_equal(scene.count, chosen);
    assert_memory_equal(scene.gaussians, kept, chosen * sizeof *kept);
    request.gaussians = chosen / 2;
    assert_int_equal(t3r_rebuild(s.rt, &request, &scene), T3R_OK);
    assert_true(scene.count <= chosen / 2);
    arena_free(&s.memory);
}

/* With fewer than a hundred points the first trial is one. */
TEST(few_points)
{
    make_views(90);
    for (uint32_t v = 0; v < VIEWS; v++) {
        for (uint32_t i = 0; i < PIXELS; i++) {
            if (i % 200 != 33) {
                depth[v][2 * i] = depth[v][2 * i + 1] = 0;
            }
        }
    }
    site s = site_of(VIEWS * PIXELS, VIEWS);
    const t3r_scene scene = within(&s, HALF_DB);
    assert_in_range(scene.valid_points, 1, 99);
    assert_in_range(scene.count, 1, scene.valid_points);
    arena_free(&s.memory);
}

TEST(a_blank_wall_needs_next_to_nothing)
{
    make_views(0);
    site s = site_of(VIEWS * PIXELS, VIEWS);
    t3r_scene scene = within(&s, HALF_DB);
    assert_true(scene.count < VIEWS * PIXELS / 100);
    arena_free(&s.memory);
}

/* The error of the scene in the arena is the error of the rendered context views. */
TEST(the_error_is_that_of_the_picture)
{
    make_views(90);
    site s = site_of(400, VIEWS);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(s.rt, NULL, &scene), T3R_OK);
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(s.rt, views);
    uint32_t error_q8;
    assert_int_equal(t3r_refine_error(s.rt, views, &error_q8), T3R_OK);
    double sum = 0;
    for (uint32_t v = 0; v < VIEWS; v++) {
        uint8_t drawn[PIXELS * 3];
        t3r_target target = {.width = SIDE, .height = SIDE, .rgb = drawn, .rgb_stride_bytes = 3 * SIDE};
        assert_int_equal(t3r_render(s.rt, &camera[v], &target), T3R_OK);
        for (size_t i = 0; i < sizeof drawn; i++) {
            sum += (drawn[i] - rgb[v][i]) * (drawn[i] - rgb[v][i]);
        }
    }
    double drawn_error = sum / (VIEWS * PIXELS * 3);
    assert_true(drawn_error > 20);
    assert_true(fabs(error_q8 / 256.0 - drawn_error) < 0.01 * drawn_error + 0.1); /* pictures round to 8 bits */
    arena_free(&s.memory);
}

TEST(cancelled_anywhere)
{
    make_views(90);
    site s = site_of(VIEWS * PIXELS, VIEWS);
    t3r_hooks hooks = {.user = &s, .progress = progress};
    assert_int_equal(t3r_set_hooks(s.rt, &hooks), T3R_OK);
    uint32_t count = within(&s, HALF_DB).count;
    assert_int_equal(t3r_reset(s.rt), T3R_OK);
    add_views(&s, VIEWS);
    int32_t calls = 0;
    for (bool done = false; !done; calls += T3R_SANITIZED ? 3 : 1) {
        t3r_config before = s.rt->config;
        t3r_scene scene;
        s.calls_left = calls;
        t3r_status status = t3r_reconstruct(s.rt, &half_db, &scene);
        done = status == T3R_OK;
        if (done) {
            assert_int_equal(scene.count, count);
        } else {
            assert_int_equal(status, T3R_ERR_CANCELLED);
            assert_int_equal(t3r_get_scene(s.rt, &scene), T3R_ERR_STATE);
            assert_memory_equal(&before, &s.rt->config, sizeof before);
        }
    }
    assert_true(calls > 30); /* analysis and three builds */
    arena_free(&s.memory);
}

/* A copied arena's planes may have no depth at all: then the error is 0. */
TEST(planes_without_depth_do_no_harm)
{
    make_views(90);
    site s = site_of(VIEWS * PIXELS, VIEWS);
    t3r_scene scene = within(&s, HALF_DB);
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(s.rt, views);
    uint32_t error_q8;
    assert_int_equal(t3r_refine_error(s.rt, views, &error_q8), T3R_OK);
    assert_true(error_q8 > 0);
    for (uint32_t v = 0; v < VIEWS; v++) {
        memset(views[v].validity, T3R_NO_DEPTH, PIXELS);
    }
    assert_int_equal(t3r_refine_error(s.rt, views, &error_q8), T3R_OK);
    assert_int_equal(error_q8, 0);
    assert_int_equal(t3r_rebuild(s.rt, &half_db, &scene), T3R_OK);
    arena_free(&s.memory);
}

TEST(refusals)
{
    make_views(90);
    t3r_scene scene;
    site s = site_of(100, VIEWS);
    assert_int_equal(t3r_reconstruct(NULL, &half_db, &scene), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_reconstruct(s.rt, &half_db, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_reconstruct(s.rt, &(t3r_request){.max_loss_q8 = T3R_MAX_LOSS_Q8 + 1}, &scene),
                     T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_rebuild(s.rt, &half_db, &scene), T3R_ERR_STATE); /* no analysis yet */
    (void)within(&s, HALF_DB);
    assert_int_equal(t3r_rebuild(s.rt, &(t3r_request){.gaussians = 101, .max_loss_q8 = HALF_DB}, &scene),
                     T3R_ERR_ARGUMENT);
    s.rt->config.refine = 0;
    assert_int_equal(t3r_reconstruct(s.rt, &half_db, &scene), T3R_ERR_STATE);
    s.rt->config.refine = 4;
    s.rt->config.keep_analysis = 0;
    assert_int_equal(t3r_reconstruct(s.rt, &half_db, &scene), T3R_ERR_STATE);
    arena_free(&s.memory);
    s = site_of(100, 1);
    s.rt->config.depth = T3R_DEPTH_STEREO; /* of one view */
    assert_int_equal(t3r_reconstruct(s.rt, &half_db, &scene), T3R_ERR_STATE);
    arena_free(&s.memory);
}
