/* SPDX-License-Identifier: Apache-2.0 */
/* Consecutive builds (t3r_config.warm): a pair of views slides along a textured wall with boxes before it. The bits
 * depend on the calls alone; outdated results are not reused. */
#include <math.h>
#include <stdbool.h>
#include <stdlib.h>
#include <string.h>

#include "oracle/float64/drawing.h"
#include "rgbd_frame.h"
#include "sanitized.h"
#include "sanitized_cpu.h"
#include "state/state.h"
#include "test.h"

enum { W = 64, H = 48, PIXELS = W * H, BUDGET = 500, STEPS = 5, PASSES = 4 };

/* ---- the walk ---------------------------------------------------------------------------------------------------- */

typedef struct viewpoint {
    double x; /* the camera's place in metres; the wall is at z = 2, boxes 0.4 before it */
    int hue;
} viewpoint;

static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2]; /* for every frame in turn */

static t3r_frame look_from(const viewpoint *s, t3r_camera *camera)
{
    *camera = plain_camera(50, W, H);
    camera->position_q32[0] = (int64_t)(s->x * 4294967296.0);
    for (int i = 0; i < PIXELS; i++) {
        double u = (i % W - (W - 1) / 2.0) / 50, v = ((double)(i / W) - (H - 1) / 2.0) / 50;
        double at = s->x + u * 1.6;
        bool box = at - floor(at) < 0.3;
        double z = box ? 1.6 : 2, x = box ? at + 17 : s->x + u * z;
        uint32_t steps = i % 41 == 0 || (i % W < 9 && i / W > 30) ? 0 : (uint32_t)(z * 1000 + 0.5);
        rgb[3 * i] = (uint8_t)(128 + 90 * sin(x * 3) * cos(v * z * 4));
        rgb[3 * i + 1] = (uint8_t)(128 + 60 * sin(x * 11 + v * z * 5));
        rgb[3 * i + 2] = (uint8_t)(box ? 220 : s->hue);
        depth[2 * i] = (uint8_t)steps;
        depth[2 * i + 1] = (uint8_t)(steps >> 8);
    }
    return rgbd_frame(rgb, depth, W, H, MILLIMETRE_Q40);
}

static viewpoint step_at(int step)
{
    return (viewpoint){0.2 * step, 60};
}

/* ---- the runtime ------------------------------------------------------------------------------------------------- */

typedef struct site {
    t3r_config config;
    arena memory;
    t3r_runtime *rt;
    uint32_t calls, cancel_at; /* calls of the progress hook; 0 = never */
    uint32_t refining;         /* views refined, counted in each pass */
    uint32_t refined;          /* the view refined last, plus 1 */
    uint64_t hash[T3R_STAGE_COUNT];
} site;

static int progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    site *s = user;
    assert_true(stage < T3R_STAGE_COUNT && done <= total);
    if (stage == T3R_STAGE_REFINE && done + 1 != s->refined) { /* each is reported several times */
        s->refining++;
        s->refined = done + 1;
    }
    return ++s->calls == s->cancel_at;
}

static void on_hash(void *user, t3r_stage stage, uint64_t hash)
{
    ((site *)user)->hash[stage] = hash;
}

/* The last task first, workers in turn. */
static void in_reverse(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                       void *context)
{
    const site *s = user;
    while (count-- > 0) {
        task(context, count, count % s->config.workers);
    }
}

static void set_hooks(site *s)
{
    const t3r_hooks hooks = {.user = s,
                             .progress = progress,
                             .stage_hash = on_hash,
                             .parallel_for = s->config.workers > 1 ? in_reverse : NULL};
    assert_int_equal(t3r_set_hooks(s->rt, &hooks), T3R_OK);
}

static t3r_config config_of(uint32_t warm)
{
    t3r_config c = t3r_default_config(W, H, 2, BUDGET);
    c.clusters = 40;
    c.refine = PASSES;
    c.fit_passes = c.align = 0; /* as consecutive builds are */
    c.warm = warm;
    return c;
}

static site *site_of(t3r_config config, int arena_size)
{
    site *s = calloc(1, sizeof *s);
    assert_non_null(s);
    s->config = config;
    s->memory = arena_of(&config, arena_size);
    assert_int_equal(t3r_init(&s->rt, s->memory.bytes, s->memory.count, &config), T3R_OK);
    vectors_if_sanitized(s->rt);
    set_hooks(s);
    return s;
}

static void site_free(site *s)
{
    arena_free(&s->memory);
    free(s);
}

/* Moves the arena's bytes elsewhere. */
static void move(site *s)
{
    arena elsewhere = arena_of_bytes(s->memory.count);
    memcpy(elsewhere.bytes, s->memory.bytes, s->memory.count);
    memset(s->memory.bytes, 0xa5, s->memory.count);
    arena_free(&s->memory);
    s->memory = elsewhere;
    assert_int_equal(t3r_attach(&s->rt, s->memory.bytes, s->memory.count), T3R_OK);
    vectors_if_sanitized(s->rt);
    set_hooks(s);
}

static void add(site *s, viewpoint at)
{
    t3r_camera camera;
    const t3r_frame frame = look_from(&at, &camera);
    assert_int_equal(t3r_add_view(s->rt, &frame, &camera), T3R_OK);
}

static t3r_scene build(site *s)
{
    t3r_scene scene;
    s->refining = s->refined = 0;
    assert_int_equal(t3r_reconstruct(s->rt, NULL, &scene), T3R_OK);
    assert_int_equal(scene.count, BUDGET);
    return scene;
}

/* Builds the pair of `step` and the previous one, after all earlier pairs; the caller frees the scene. */
static t3r_gaussian *slide(site *s, bool moved)
{
    t3r_gaussian *scenes = calloc(STEPS * BUDGET, sizeof *scenes);
    uint8_t picture[PIXELS * 3];
    const t3r_target target = {.width = W, .height = H, .rgb = picture, .rgb_stride_bytes = 3 * W};
    assert_non_null(scenes);
    add(s, step_at(0));
    for (int step = 1; step <= STEPS; step++) {
        if (moved) {
            move(s);
        }
        add(s, step_at(step));
        if (moved) {
            move(s);
        }
        const t3r_scene scene = build(s);
        memcpy(scenes + (step - 1) * BUDGET, scene.gaussians, BUDGET * sizeof *scenes);
        t3r_camera camera = plain_camera(50, W, H);
        camera.position_q32[0] = (int64_t)((step - 0.5) * 0.2 * 4294967296.0);
        assert_int_equal(t3r_render(s->rt, &camera, &target), T3R_OK);
    }
    return scenes;
}

/* Compares with the scene that a fresh runtime makes of these views. */
static void assert_anew(const t3r_scene *scene, viewpoint first, viewpoint second)
{
    site *cold = site_of(config_of(0), ARENA_AT_FULL);
    add(cold, first);
    add(cold, second);
    const t3r_scene expected = build(cold);
    assert_int_equal(scene->count, expected.count);
    assert_memory_equal(scene->gaussians, expected.gaussians, scene->count * sizeof(t3r_gaussian));
    assert_memory_equal(scene->frame.origin_q32, expected.frame.origin_q32, sizeof expected.frame.origin_q32);
    assert_int_equal(scene->frame.exponent, expected.frame.exponent);
    site_free(cold);
}

/* ---- tests ------------------------------------------------------------------------------------------------------- */

TEST(the_first_build_begins_anew)
{
    site *s = site_of(config_of(1), ARENA_AT_FULL);
    for (int again = 0; again < 2; again++) {
        add(s, step_at(0));
        add(s, step_at(1));
        const t3r_scene scene = build(s);
        assert_anew(&scene, step_at(0), step_at(1));
        assert_int_equal(s->refining, PASSES * 2);
        add(s, step_at(2));
        (void)build(s);
        assert_int_equal(s->refining, PASSES / 2 * 2);
        assert_int_equal(t3r_reset(s->rt), T3R_OK);
    }
    site_free(s);
}

TEST(same_bits)
{
    site *s = site_of(config_of(1), ARENA_AT_FULL);
    t3r_gaussian *expected = slide(s, false);
    site_free(s);
    for (int way = 0; way < 5; way++) {
        t3r_config config = config_of(1);
        config.workers = way == 3 ? 3 : way == 4 ? 8 : 1;
        config.keep_analysis = way == 2;
        s = site_of(config, way == 1 || way == 4 ? ARENA_AT_MINIMUM : way == 2 ? ARENA_AT_TEN_TIMES : ARENA_AT_FULL);
        t3r_gaussian *scenes = slide(s, way % 2 == 0);
        assert_memory_equal(scenes, expected, STEPS * BUDGET * sizeof *scenes);
        free(scenes);
        site_free(s);
    }
    free(expected);
}

/* Drawing ends an analysis that is not kept, and keeps the views. Without refinement, which would end the analysis
 * earlier. */
TEST(a_drawn_arena_moves)
{
    t3r_config config = config_of(1);
    config.refine = 0;
    site *s = site_of(config, ARENA_AT_MINIMUM);
    t3r_gaussian *expected = slide(s, false);
    site_free(s);
    s = site_of(config, ARENA_AT_MINIMUM);
    t3r_gaussian *scenes = slide(s, true);
    assert_memory_equal(scenes, expected, STEPS * BUDGET * sizeof *scenes);
    site_free(s);
    free(scenes);
    free(expected);
}

/* Textures belong to one view: kept ones, and the new view's, equal those of a fresh runtime. */
TEST(a_view_that_changed_is_not_taken_for_the_old)
{
    site *s = site_of(config_of(1), ARENA_AT_FULL);
    add(s, step_at(0));
    add(s, step_at(1));
    (void)build(s);
    const viewpoint changed = {step_at(0).x, 200}; /* the same camera, the same memory, other colours */
    add(s, changed);
    (void)build(s);
    site *cold = site_of(config_of(0), ARENA_AT_FULL);
    add(cold, changed);
    add(cold, step_at(1));
    (void)build(cold);
    assert_true(s->hash[T3R_STAGE_IMAGE] == cold->hash[T3R_STAGE_IMAGE]);
    assert_true(s->hash[T3R_STAGE_WAVELET] == cold->hash[T3R_STAGE_WAVELET]);
    site_free(cold);
    /* the oldest view is dropped: the second one, and then the first */
    add(s, step_at(2));
    (void)build(s);
    cold = site_of(config_of(0), ARENA_AT_FULL);
    add(cold, changed);
    add(cold, step_at(2));
    (void)build(cold);
    assert_true(s->hash[T3R_STAGE_IMAGE] == cold->hash[T3R_STAGE_IMAGE]);
    assert_true(s->hash[T3R_STAGE_WAVELET] == cold->hash[T3R_STAGE_WAVELET]);
    site_free(cold);
    site_free(s);
}

/* A call that is refused before it writes does not change the pair. */
TEST(errors_in_between)
{
    site *s = site_of(config_of(1), ARENA_AT_FULL);
    t3r_gaussian *expected = slide(s, false);
    site_free(s);

    s = site_of(config_of(1), ARENA_AT_FULL);
    const viewpoint next = step_at(2);
    t3r_camera camera;
    add(s, step_at(0));
    add(s, step_at(1));
    (void)build(s);
    t3r_frame bad = look_from(&next, &camera);
    bad.stride_bytes[0] = 1;
    assert_int_equal(t3r_add_view(s->rt, &bad, &camera), T3R_ERR_FRAME);
    bad = look_from(&next, &camera);
    t3r_camera nowhere = camera;
    nowhere.fx_q16 = 0;
    assert_int_equal(t3r_add_view(s->rt, &bad, &nowhere), T3R_ERR_CAMERA);
    bad.depth = NULL;
    assert_int_equal(t3r_add_view(s->rt, &bad, &camera), T3R_ERR_NO_DEPTH);
    bad = look_from(&next, &camera);
    memset(depth, 0, sizeof depth);
    assert_int_equal(t3r_add_view(s->rt, &bad, &camera), T3R_ERR_NO_DEPTH);
    t3r_scene scene;
    assert_int_equal(t3r_get_scene(s->rt, &scene), T3R_OK); /* still there */
    move(s);
    const t3r_request too_many = {.gaussians = BUDGET + 1};
    assert_int_equal(t3r_reconstruct(s->rt, &too_many, &scene), T3R_ERR_ARGUMENT);
    add(s, next);
    scene = build(s);
    assert_memory_equal(scene.gaussians, expected + BUDGET, BUDGET * sizeof *expected);

    /* a single measurement, which resizing and undistortion lose: all views are dropped */
    bad = look_from(&next, &camera);
    memset(depth, 0, sizeof depth);
    depth[0] = 200;
    camera.distortion = T3R_DISTORTION_RADTAN;
    camera.distortion_q24[0] = -1200000;
    assert_int_equal(t3r_add_view(s->rt, &bad, &camera), T3R_ERR_NO_DEPTH);
    assert_int_equal(t3r_reconstruct(s->rt, NULL, &scene), T3R_ERR_STATE);
    add(s, step_at(0));
    add(s, step_at(1));
    scene = build(s);
    assert_anew(&scene, step_at(0), step_at(1));
    free(expected);
    site_free(s);
}

TEST(cancelled_builds_leave_nothing)
{
    uint32_t calls = UINT32_MAX;
    for (uint32_t at = 1; at <= calls; at += T3R_SANITIZED ? 13 : 3) {
        site *s = site_of(config_of(1), ARENA_AT_FULL);
        add(s, step_at(0));
        add(s, step_at(1));
        (void)build(s);
        add(s, step_at(2)); /* in place of the first view */
        s->calls = 0;
        if (calls == UINT32_MAX) { /* counts the calls */
            site *whole = site_of(config_of(1), ARENA_AT_FULL);
            add(whole, step_at(0));
            add(whole, step_at(1));
            (void)build(whole);
            add(whole, step_at(2));
            whole->calls = 0;
            (void)build(whole);
            calls = whole->calls;
            site_free(whole);
        }
        s->cancel_at = at;
        t3r_scene scene;
        assert_int_equal(t3r_reconstruct(s->rt, NULL, &scene), T3R_ERR_CANCELLED);
        s->cancel_at = 0;
        if (at % 2 == 0) {
            move(s);
        }
        scene = build(s);
        assert_anew(&scene, step_at(2), step_at(1));
        site_free(s);
    }
}

/* Views at another scale, or far from the origin, are built from scratch. */
TEST(another_frame_begins_anew)
{
    site *s = site_of(config_of(1), ARENA_AT_FULL);
    add(s, step_at(0));
    add(s, step_at(1));
    (void)build(s);
    for (int turn = 0; turn < 3;
         turn++) { /* 2 m a scene unit: the first two views are in range of the previous frame */
        const double x = turn == 0 ? 1500 : turn == 1 ? -300 : 3000;
        const viewpoint far = {x, 60}, farther = {x + 0.2, 60};
        add(s, far);
        add(s, farther);
        const t3r_scene scene = build(s);
        assert_anew(&scene, far, farther);
    }
    for (int i = 0; i < 2; i++) { /* the same wall in steps eight times as long */
        t3r_camera camera;
        const viewpoint at = step_at(i);
        t3r_frame frame = look_from(&at, &camera);
        frame.depth_unit_q40 *= 8;
        assert_int_equal(t3r_add_view(s->rt, &frame, &camera), T3R_OK);
    }
    (void)build(s);
    assert_int_equal(s->refining, PASSES * 2);
    site_free(s);
}

TEST(without_views_none_is_taken)
{
    t3r_config config = config_of(1);
    config.views = 0;
    site *s = site_of(config, ARENA_AT_MINIMUM);
    const viewpoint at = step_at(0);
    t3r_camera camera;
    const t3r_frame frame = look_from(&at, &camera);
    assert_int_equal(t3r_add_view(s->rt, &frame, &camera), T3R_ERR_STATE);
    site_free(s);
}

/* An arena with impossible views or centres is refused. */
TEST(damaged_arenas)
{
    site *s = site_of(config_of(1), ARENA_AT_FULL);
    add(s, step_at(0));
    add(s, step_at(1));
    (void)build(s);
    t3r_runtime *rt = s->rt;
    const t3r_reuse good = rt->reuse;
    rt->reuse.views = 4;
    assert_int_equal(t3r_attach(&s->rt, s->memory.bytes, s->memory.count), T3R_ERR_EPOCH);
    rt->reuse = (t3r_reuse){1, 0};
    assert_int_equal(t3r_attach(&s->rt, s->memory.bytes, s->memory.count), T3R_ERR_EPOCH);
    rt->reuse = good;
    rt->next_slot = 2;
    assert_int_equal(t3r_attach(&s->rt, s->memory.bytes, s->memory.count), T3R_ERR_EPOCH);
    rt->next_slot = 0;
    int32_t *centre = t3r_buffer_at(rt, T3R_BUFFER_KEPT_CLUSTERS);
    const int32_t kept = *centre;
    *centre = INT32_MAX;
    assert_int_equal(t3r_attach(&s->rt, s->memory.bytes, s->memory.count), T3R_ERR_EPOCH);
    *centre = kept;
    assert_int_equal(t3r_attach(&s->rt, s->memory.bytes, s->memory.count), T3R_OK);
    site_free(s);
}
