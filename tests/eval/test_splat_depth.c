/* SPDX-License-Identifier: Apache-2.0 */
/* Depth from a scene's means: the mean that each pixel gets, and its steps. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "reconstruction/splat_depth.h"
#include "test.h"

#define WIDTH 8u
#define HEIGHT 6u
#define PIXELS (WIDTH * HEIGHT)
#define MOST 64u
#define FOCAL 20.0
#define EXPONENT 2 /* a scene unit is four world units */

/* A scene and its camera: a quarter turn to the left about y, away from the world's origin. */
typedef struct stage {
    t3r_gaussian gaussians[MOST];
    scene_file scene;
    t3r_camera camera;
    splat_depth depth;
} stage;

static void begin(stage *s)
{
    memset(s, 0, sizeof *s);
    s->scene = (scene_file){.frame = {{(int64_t)7 << 32, 0, -((int64_t)3 << 32)}, EXPONENT}, .gaussians = s->gaussians};
    s->camera = (t3r_camera){.fx_q16 = (int32_t)(FOCAL * 65536),
                             .fy_q16 = (int32_t)(FOCAL * 65536),
                             .cx_q16 = (int32_t)(WIDTH - 1) * 32768,
                             .cy_q16 = (int32_t)(HEIGHT - 1) * 32768,
                             .position_q32 = {(int64_t)9 << 32, (int64_t)1 << 32, 0},
                             .rotation_q30 = {759250125, 0, -759250125, 0}};
}

/* Places a mean `depth` world units away, seen at column x, row y. */
static void place(stage *s, double x, double y, double depth, uint16_t opacity_q15)
{
    double right = (x - (WIDTH - 1) / 2.0) / FOCAL * depth, down = (y - (HEIGHT - 1) / 2.0) / FOCAL * depth;
    /* the turn takes the camera's z to -x of the world and its x to z */
    const double world[3] = {9 - depth, 1 + down, right}, origin[3] = {7, 0, -3};
    t3r_gaussian *g = &s->gaussians[s->scene.count++];
    assert_true(s->scene.count <= MOST);
    for (int i = 0; i < 3; i++) {
        g->position_q20[i] = (int32_t)lround(ldexp(world[i] - origin[i], 20 - EXPONENT));
    }
    g->opacity_q15 = opacity_q15;
}

static void make(stage *s)
{
    free(s->depth.steps);
    assert_true(splat_depth_make(&s->depth, &s->scene, &s->camera, WIDTH, HEIGHT));
}

static uint32_t steps_at(const stage *s, uint32_t x, uint32_t y)
{
    const uint8_t *at = &s->depth.steps[2 * (y * WIDTH + x)];
    return at[0] | (uint32_t)at[1] << 8;
}

static double depth_at(const stage *s, uint32_t x, uint32_t y)
{
    return steps_at(s, x, y) * ldexp((double)s->depth.unit_q40, -40);
}

static void expect_depth(const stage *s, uint32_t x, uint32_t y, double depth)
{
    assert_true(fabs(depth_at(s, x, y) - depth) < 0.001 * depth);
}

TEST(every_pixel_has_its_own)
{
    stage s;
    begin(&s);
    for (uint32_t i = 0; i < PIXELS; i++) {
        place(&s, i % WIDTH, i / WIDTH, 3 + 0.25 * i, 32767);
    }
    make(&s);
    assert_int_equal(s.depth.seen, PIXELS);
    double unit = ldexp((double)s.depth.unit_q40, -40), largest = 3 + 0.25 * (PIXELS - 1);
    assert_true(fabs(unit * 65535 / largest - 1) < 1e-4);
    for (uint32_t i = 0; i < PIXELS; i++) {
        double depth = 3 + 0.25 * i;
        /* half a step, and the scene's own rounding: a Q20 step of a scene unit */
        assert_true(fabs(depth_at(&s, i % WIDTH, i / WIDTH) - depth) <= unit * 0.501 + ldexp(1, EXPONENT - 20));
    }
    free(s.depth.steps);
}

TEST(nearest_wins)
{
    for (int order = 0; order < 2; order++) {
        stage s;
        begin(&s);
        place(&s, 2.3, 4, order == 0 ? 2 : 5, 32767);
        place(&s, 2.3, 4, order == 0 ? 5 : 2, 32767);
        make(&s);
        assert_int_equal(s.depth.seen, 1);
        expect_depth(&s, 2, 4, 2);
        free(s.depth.steps);
    }
}

/* The surface's mean nearest to the pixel's centre is used, and no mean behind the surface. */
TEST(surface_is_sampled_at_the_centre)
{
    const double behind[] = {1.04, 1.08}, found[] = {1.04, 1};
    for (int i = 0; i < 4; i++) {
        stage s;
        begin(&s);
        for (int k = 0; k < 2; k++) {
            bool front = (k == 0) == (i < 2);
            place(&s, 5 - (front ? 0.4 : 0.1), 1, front ? 4 : 4 * behind[i % 2], 32767);
        }
        make(&s);
        expect_depth(&s, 5, 1, 4 * found[i % 2]);
        free(s.depth.steps);
    }
}

TEST(faint_means_are_no_surface)
{
    stage s;
    begin(&s);
    place(&s, 1, 1, 2, SPLAT_DEPTH_OPACITY_Q15 - 1);
    place(&s, 1, 1, 3, SPLAT_DEPTH_OPACITY_Q15);
    place(&s, 2, 1, 2, 0);
    make(&s);
    assert_int_equal(s.depth.seen, 1);
    expect_depth(&s, 1, 1, 3);
    assert_int_equal(steps_at(&s, 2, 1), 0);
    free(s.depth.steps);
}

TEST(borders_and_behind)
{
    const double last_x = WIDTH - 1, last_y = HEIGHT - 1;
    stage s;
    begin(&s);
    place(&s, -0.49, 1, 2, 32767);
    place(&s, last_x + 0.49, 1, 3, 32767);
    place(&s, 3, -0.49, 4, 32767);
    place(&s, 3, last_y + 0.49, 5, 32767);
    place(&s, -0.51, 2, 2, 32767);
    place(&s, last_x + 0.51, 2, 2, 32767);
    place(&s, 4, -0.51, 2, 32767);
    place(&s, 4, last_y + 0.51, 2, 32767);
    place(&s, 5, 3, -2, 32767);
    place(&s, 5, 3, 0, 32767);
    place(&s, 1e4, 3, 1, 32767);
    make(&s);
    assert_int_equal(s.depth.seen, 4);
    expect_depth(&s, 0, 1, 2);
    expect_depth(&s, WIDTH - 1, 1, 3);
    expect_depth(&s, 3, 0, 4);
    expect_depth(&s, 3, HEIGHT - 1, 5);
    free(s.depth.steps);
}

TEST(nothing_is_seen)
{
    stage s;
    begin(&s);
    place(&s, 3, 3, -2, 32767);
    make(&s);
    assert_int_equal(s.depth.seen, 0);
    assert_int_equal(s.depth.unit_q40, 1);
    for (uint32_t i = 0; i < PIXELS; i++) {
        assert_int_equal(steps_at(&s, i % WIDTH, i / WIDTH), 0);
    }
    free(s.depth.steps);
}

/* A single stray mean does not reduce the others' resolution. */
TEST(far_ones_are_brought_near)
{
    stage s;
    begin(&s);
    for (uint32_t i = 0; i < PIXELS; i++) {
        place(&s, i % WIDTH, i / WIDTH, i == 9 ? 800 : 0.5, 32767);
    }
    make(&s);
    assert_int_equal(s.depth.seen, PIXELS);
    assert_in_range(steps_at(&s, 0, 0), 65535 / SPLAT_DEPTH_MEDIANS - 1, 65535 / SPLAT_DEPTH_MEDIANS + 1);
    assert_int_equal(steps_at(&s, 9 % WIDTH, 9 / WIDTH), 65535);
    expect_depth(&s, 0, 0, 0.5);
    free(s.depth.steps);
}
