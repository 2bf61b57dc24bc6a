/* SPDX-License-Identifier: Apache-2.0 */
/* Pose correction until views agree: a disturbed pose is restored, right poses stay bit for bit, repeated analyses
 * start from the given poses, builds that may not be aligned are not; and the small equations are solved as in
 * doubles. */
#include "rgbd_frame.h"
#include "unit/unit.h"

#include <math.h>
#include <stdlib.h>

#include "core/camera.h"
#include "core/hash.h"
#include "loss/budget_choice.h"
#include "pointmap/align_solve.h"
#include "room/room.h"
#include "state/state.h"
#include "state/views.h"

enum { SIDE = 96, VIEWS = 3, BUDGET = SIDE * SIDE / 5 };

static uint8_t rgb[VIEWS][SIDE * SIDE * 3], depth[VIEWS][SIDE * SIDE * 2];
static t3r_camera camera[VIEWS];
static void *memory;

static int draw_room(void **state)
{
    (void)state;
    static uint16_t depth_mm[SIDE * SIDE];
    for (uint32_t v = 0; v < VIEWS; v++) {
        room_camera(v, SIDE, SIDE, &camera[v]);
        room_frame(v, SIDE, SIDE, 1, rgb[v], depth_mm);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            depth[v][2 * i] = (uint8_t)depth_mm[i];
            depth[v][2 * i + 1] = (uint8_t)(depth_mm[i] >> 8);
        }
    }
    return 0;
}

static t3r_config settings(uint32_t views, uint32_t align)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, views, BUDGET);
    config.refine = 1;
    config.align = align;
    return config;
}

static t3r_runtime *with_pictures(const t3r_config *config, const t3r_camera cameras[],
                                  const uint8_t pictures[][SIDE * SIDE * 3])
{
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    free(memory);
    memory = aligned_alloc(T3R_ARENA_ALIGN, plan.bytes);
    t3r_runtime *rt = NULL;
    assert_int_equal(t3r_init(&rt, memory, plan.bytes, config), T3R_OK);
    for (uint32_t v = 0; v < config->views; v++) {
        const t3r_frame frame = rgbd_frame(pictures[v], depth[v], SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
        assert_int_equal(t3r_add_view(rt, &frame, &cameras[v]), T3R_OK);
    }
    return rt;
}

static t3r_runtime *with_views(const t3r_config *config, const t3r_camera cameras[])
{
    return with_pictures(config, cameras, (const uint8_t(*)[SIDE * SIDE * 3]) rgb);
}

static uint64_t scene_hash(t3r_runtime *rt)
{
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    return t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)scene.gaussians, scene.count * sizeof *scene.gaussians);
}

/* Returns a camera turned `angle` radians too far and shifted by `shift` metres. */
static t3r_camera disturbed(const t3r_camera *from, double angle, double shift)
{
    t3r_camera c = *from;
    const double half = angle / 2, w = from->rotation_q30[0], x = from->rotation_q30[1], y = from->rotation_q30[2],
                 z = from->rotation_q30[3];
    c.rotation_q30[0] = (int32_t)lrint(w * cos(half) - y * sin(half));
    c.rotation_q30[1] = (int32_t)lrint(x * cos(half) + z * sin(half));
    c.rotation_q30[2] = (int32_t)lrint(y * cos(half) + w * sin(half));
    c.rotation_q30[3] = (int32_t)lrint(z * cos(half) - x * sin(half));
    c.position_q32[0] += llrint(ldexp(shift, 32));
    return c;
}

static double turned(const t3r_camera *a, const t3r_camera *b)
{
    double dot = 0, aa = 0, bb = 0;
    for (int i = 0; i < 4; i++) {
        dot += (double)a->rotation_q30[i] * b->rotation_q30[i];
        aa += (double)a->rotation_q30[i] * a->rotation_q30[i];
        bb += (double)b->rotation_q30[i] * b->rotation_q30[i];
    }
    return 2 * acos(fmin(1, fabs(dot) / sqrt(aa * bb)));
}

/* Returns the error of the rotation between two cameras, against the room's own. */
static double error_of_turn(const t3r_camera *first, const t3r_camera *second, uint32_t to)
{
    return fabs(turned(first, second) - turned(&camera[0], &camera[to]));
}

TEST(a_disturbed_pose_comes_back)
{
    static const struct {
        double angle, shift;
    } by[] = {{0.01, 0}, {-0.02, 0}, {0.02, 0.03}, {-0.01, -0.03}};
    for (size_t i = 0; i < sizeof by / sizeof *by; i++) {
        const t3r_config config = settings(2, 1), plain = settings(2, 0);
        const t3r_camera cameras[] = {camera[0], disturbed(&camera[1], by[i].angle, by[i].shift)};
        t3r_runtime *rt = with_views(&config, cameras);
        const uint64_t hash = scene_hash(rt);
        t3r_camera found[2];
        for (uint32_t v = 0; v < 2; v++) {
            assert_int_equal(t3r_view_camera(rt, v, &found[v]), T3R_OK);
            assert_true(turned(&found[v], &cameras[v]) > fabs(by[i].angle) / 8); /* each corrects a part of it */
        }
        const double before = error_of_turn(&cameras[0], &cameras[1], 1),
                     behind = error_of_turn(&found[0], &found[1], 1);
        assert_true(behind < before / 2); /* the rest is a shift with nearly the same effect */
        print_message("%.3f radians, %.2f m: turn off by %.5f, then by %.5f\n", by[i].angle, by[i].shift, before,
                      behind);
        assert_true(scene_hash(rt) == hash); /* from the given poses, not from the aligned ones */
        assert_true(scene_hash(with_views(&plain, cameras)) != hash);
    }
}

/* When only an eighth of the pixels has depth, these are compared more densely than with depth everywhere. */
TEST(little_depth_is_enough)
{
    enum { FIRST = SIDE * 21 / 64, LAST = SIDE * 43 / 64 };
    const t3r_config config = settings(2, 1);
    const t3r_camera cameras[] = {camera[0], disturbed(&camera[1], 0.02, 0)};
    static uint8_t whole[VIEWS][SIDE * SIDE * 2];
    memcpy(whole, depth, sizeof depth);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        if (i % SIDE < FIRST || i % SIDE >= LAST || i / SIDE < FIRST || i / SIDE >= LAST) {
            for (uint32_t v = 0; v < VIEWS; v++) {
                depth[v][2 * i] = depth[v][2 * i + 1] = 0;
            }
        }
    }
    t3r_runtime *rt = with_views(&config, cameras);
    memcpy(depth, whole, sizeof depth);
    (void)scene_hash(rt);
    t3r_camera found[2];
    for (uint32_t v = 0; v < 2; v++) {
        assert_int_equal(t3r_view_camera(rt, v, &found[v]), T3R_OK);
    }
    const double before = error_of_turn(&cameras[0], &cameras[1], 1), behind = error_of_turn(&found[0], &found[1], 1);
    print_message("little depth: turn off by %.5f, then by %.5f\n", before, behind);
    assert_true(4 * behind < 3 * before); /* in a small window a shift has nearly the same effect */
}

/* A target view has a pose like the given ones, so its loss is measured before alignment. */
TEST(a_bounded_loss_goes_by_the_poses_given)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, SIDE * SIDE);
    config.keep_analysis = 1;
    const t3r_camera cameras[] = {camera[0], disturbed(&camera[1], 0.02, 0)};
    t3r_runtime *rt = with_views(&config, cameras);
    (void)scene_hash(rt);
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    const t3r_pose before = views[1].pose;
    uint32_t chosen[2];
    for (int i = 0; i < 2; i++) {
        t3r_build build = t3r_build_of(&config);
        assert_int_equal(t3r_choose_budget(rt, views, T3R_MAX_LOSS_Q8 / 4, &build, NULL), T3R_OK);
        assert_memory_equal(&views[1].pose, &before, sizeof before);
        chosen[i] = build.gaussians;
        t3r_note_placement(&rt->given[1], &rt->camera[1]); /* then as if the aligned poses had been given */
        t3r_note_placement(&rt->given[0], &rt->camera[0]);
    }
    print_message("poses off: %u Gaussians, as found: %u\n", chosen[0], chosen[1]);
    assert_true(2 * chosen[0] < chosen[1]);
    config.align = 0;
    rt = with_views(&config, camera);
    (void)scene_hash(rt);
    t3r_views_of(rt, views);
    t3r_build build = t3r_build_of(&config);
    assert_int_equal(t3r_choose_budget(rt, views, T3R_MAX_LOSS_Q8 / 4, &build, NULL), T3R_OK);
    assert_true(2 * chosen[0] < build.gaussians); /* correct poses, without alignment */
}

TEST(three_views_meet)
{
    const t3r_config config = settings(3, 1);
    const t3r_camera cameras[] = {camera[0], disturbed(&camera[1], 0.02, 0), camera[2]};
    t3r_runtime *rt = with_views(&config, cameras);
    (void)scene_hash(rt);
    t3r_camera found[3];
    for (uint32_t v = 0; v < 3; v++) {
        assert_int_equal(t3r_view_camera(rt, v, &found[v]), T3R_OK);
    }
    const double before = error_of_turn(&cameras[0], &cameras[1], 1), behind = error_of_turn(&found[0], &found[1], 1);
    print_message("three views: off by %.5f, then by %.5f and %.5f\n", before, behind,
                  error_of_turn(&found[0], &found[2], 2));
    assert_true(behind < before / 2);
    assert_true(error_of_turn(&found[0], &found[2], 2) < before / 4);
}

TEST(right_poses_stay)
{
    for (uint32_t views = 1; views <= VIEWS; views++) {
        const t3r_config config = settings(views, 1), plain = settings(views, 0);
        t3r_runtime *rt = with_views(&config, camera);
        const uint64_t hash = scene_hash(rt);
        for (uint32_t v = 0; v < views; v++) {
            t3r_camera found;
            assert_int_equal(t3r_view_camera(rt, v, &found), T3R_OK);
            assert_memory_equal(found.rotation_q30, camera[v].rotation_q30, sizeof found.rotation_q30);
            assert_memory_equal(found.position_q32, camera[v].position_q32, sizeof found.position_q32);
        }
        assert_true(scene_hash(with_views(&plain, camera)) == hash);
    }
}

/* Grey views have no differences to reduce. */
TEST(grey_views)
{
    static uint8_t grey[2][SIDE * SIDE * 3];
    memset(grey, 128, sizeof grey);
    const t3r_config config = settings(2, 1);
    t3r_runtime *rt = with_pictures(&config, camera, (const uint8_t(*)[SIDE * SIDE * 3]) grey);
    (void)scene_hash(rt);
    for (uint32_t v = 0; v < 2; v++) {
        t3r_camera found;
        assert_int_equal(t3r_view_camera(rt, v, &found), T3R_OK);
        assert_memory_equal(found.position_q32, camera[v].position_q32, sizeof found.position_q32);
    }
}

/* A view at the end of the range of positions keeps its given pose, and the other one is still aligned. */
TEST(positions_stay_in_range)
{
    const t3r_config config = settings(2, 1);
    const uint32_t outer = camera[1].position_q32[0] > camera[0].position_q32[0];
    for (int far = 0; far < 2; far++) {
        t3r_camera cameras[] = {camera[0], camera[1]}, found[2];
        cameras[outer] = disturbed(&camera[outer], -0.01, -0.06); /* has to move outwards */
        const int64_t away = far ? T3R_MAX_POSITION_Q32 - 1 - cameras[outer].position_q32[0] : 0;
        cameras[0].position_q32[0] += away;
        cameras[1].position_q32[0] += away;
        t3r_runtime *rt = with_views(&config, cameras);
        (void)scene_hash(rt);
        for (uint32_t v = 0; v < 2; v++) {
            assert_int_equal(t3r_view_camera(rt, v, &found[v]), T3R_OK);
            assert_int_equal(t3r_camera_check(&found[v], config.width, config.height), T3R_OK);
        }
        assert_true((found[outer].position_q32[0] == cameras[outer].position_q32[0]) == far);
        assert_true(turned(&found[1 - outer], &cameras[1 - outer]) > 0.005);
    }
}

/* With `warm` the poses start from the previous build. */
TEST(builds_that_follow_are_as_given)
{
    const t3r_camera cameras[] = {camera[0], disturbed(&camera[1], 0.02, 0)};
    t3r_config config = settings(2, 1);
    config.warm = 1;
    const uint64_t asked = scene_hash(with_views(&config, cameras));
    config.align = 0;
    assert_true(scene_hash(with_views(&config, cameras)) == asked);
}

/* Noise in views that share a narrow strip: they differ less if they turn away from it. Such a step is rejected, and
 * the poses stay. */
TEST(narrow_strips_of_noise)
{
    static const struct {
        double angle;
        uint64_t seed;
    } of[] = {{0.8325, UINT64_C(17674948696127779841)},
              {0.9045, UINT64_C(6744394396120544257)},
              {0.9055, UINT64_C(14534929284800945153)}};
    static uint8_t noise[VIEWS][SIDE * SIDE * 3];
    const t3r_config config = settings(2, 1);
    for (size_t n = 0; n < sizeof of / sizeof *of; n++) {
        uint64_t seed = of[n].seed;
        for (size_t i = 0; i < sizeof noise; i++) {
            noise[i / sizeof noise[0]][i % sizeof noise[0]] = (uint8_t)unit_between(&seed, 0, 255);
        }
        const t3r_camera cameras[] = {camera[0], disturbed(&camera[0], of[n].angle, 0)};
        t3r_runtime *rt = with_pictures(&config, cameras, (const uint8_t(*)[SIDE * SIDE * 3]) noise);
        (void)scene_hash(rt);
        t3r_camera found;
        assert_int_equal(t3r_view_camera(rt, 1, &found), T3R_OK);
        assert_memory_equal(found.rotation_q30, cameras[1].rotation_q30, sizeof found.rotation_q30);
    }
}

/* Views without overlap or contents keep their poses. */
TEST(views_without_anything_in_common)
{
    const t3r_config config = settings(2, 1);
    const t3r_camera away[] = {camera[0], disturbed(&camera[1], 3.0, 0)};
    t3r_camera found;
    t3r_runtime *rt = with_views(&config, away);
    (void)scene_hash(rt);
    assert_int_equal(t3r_view_camera(rt, 1, &found), T3R_OK);
    assert_memory_equal(found.rotation_q30, away[1].rotation_q30, sizeof found.rotation_q30);
    assert_int_equal(t3r_view_camera(rt, 2, &found), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_view_camera(rt, 0, NULL), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_view_camera(NULL, 0, &found), T3R_ERR_ARGUMENT);
}

static int cancel_at(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    uint32_t *left = user;
    assert_true(done < total || stage != T3R_STAGE_POINTMAP);
    return stage == T3R_STAGE_POINTMAP && (*left)-- == 0;
}

TEST(it_can_be_cancelled)
{
    const t3r_config config = settings(2, 1);
    const t3r_camera cameras[] = {camera[0], disturbed(&camera[1], 0.02, 0)};
    const uint64_t hash = scene_hash(with_views(&config, cameras));
    for (uint32_t calls = 0; calls < 12; calls++) {
        t3r_runtime *rt = with_views(&config, cameras);
        uint32_t left = calls;
        rt->hooks.progress = cancel_at;
        rt->hooks.user = &left;
        assert_int_equal(t3r_reconstruct(rt, NULL, &(t3r_scene){0}), T3R_ERR_CANCELLED);
        rt->hooks.progress = NULL;
        assert_true(scene_hash(rt) == hash);
    }
}

/* Checks the residual of A x = b for random positive definite matrices of any scale, with unequal diagonals. */
TEST(equations_are_solved)
{
    srand(1);
    for (int round = 0; round < 2000; round++) {
        double f[6][6], a[6][6], b[6], worst = 0, size = 0;
        const double scale = ldexp(1, 4 + rand() % 20);
        for (int i = 0; i < 6; i++) {
            const double own = ldexp(scale, -(rand() % 4));
            for (int j = 0; j < 6; j++) {
                f[i][j] = own * (rand() % 2001 - 1000) / 1000.0 + (i == j ? own : 0);
            }
        }
        int64_t products[T3R_ALIGN_PRODUCTS], b_q4[6];
        for (int i = 0, at = 0; i < 6; i++) {
            for (int j = i; j < 6; j++) {
                a[i][j] = i == j ? scale * scale / 64 : 0;
                for (int k = 0; k < 6; k++) {
                    a[i][j] += f[i][k] * f[j][k];
                }
                products[at++] = llrint(a[i][j]);
                a[j][i] = a[i][j];
            }
        }
        double x[6];
        for (int i = 0; i < 6; i++) {
            x[i] = (rand() % 2001 - 1000) / 50000.0; /* radians */
        }
        for (int i = 0; i < 6; i++) {
            b[i] = 0;
            for (int j = 0; j < 6; j++) {
                b[i] += a[i][j] * x[j];
            }
            b_q4[i] = llrint(16 * b[i]);
            size = fmax(size, fabs(b[i]) / sqrt(a[i][i]));
        }
        int32_t got_q30[6];
        t3r_align_solve(products, b_q4, got_q30);
        for (int i = 0; i < 6; i++) {
            double rest = -b[i];
            for (int j = 0; j < 6; j++) {
                rest += a[i][j] * ldexp(got_q30[j], -30);
            }
            worst = fmax(worst, fabs(rest) / sqrt(a[i][i]));
        }
        assert_true(worst <= size / 200 + 0.05);
    }
    const int64_t none[T3R_ALIGN_PRODUCTS] = {0}, zero[6] = {0}, large[6] = {INT64_C(1) << 60, -(INT64_C(1) << 60)};
    int32_t got_q30[6];
    t3r_align_solve(none, zero, got_q30);
    assert_int_equal(got_q30[0], 0);
    t3r_align_solve(none, large, got_q30);
    assert_int_equal(got_q30[0], T3R_ALIGN_STEP_MOST_Q30);
    assert_int_equal(got_q30[1], -T3R_ALIGN_STEP_MOST_Q30);
}

ALL_TESTS_WITH(draw_room, NULL)
