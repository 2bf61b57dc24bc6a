/* SPDX-License-Identifier: Apache-2.0 */
#include "drawing.h"

#include <math.h>
#include <setjmp.h>
#include <stdarg.h>
#include <stdlib.h>
#include <string.h>

#include <cmocka.h>

enum { GUARD_BYTES = 64, GUARD = 0x5a };

arena arena_of_bytes(size_t count)
{
    arena a = {NULL, count};
    assert_int_equal(posix_memalign(&a.bytes, T3R_ARENA_ALIGN, count == 0 ? 1 : count), 0);
    memset(a.bytes, 0xa5, count);
    return a;
}

arena arena_of(const t3r_config *config, int size)
{
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    return arena_of_bytes(size == ARENA_AT_MINIMUM ? plan.min_bytes : plan.bytes * (size_t)size);
}

void arena_free(arena *a)
{
    free(a->bytes);
    *a = (arena){0};
}

t3r_config render_config(uint32_t max_gaussians, uint32_t width, uint32_t height)
{
    t3r_config config = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 0, max_gaussians);
    config.render_width = width;
    config.render_height = height;
    return config;
}

static void *guarded(size_t bytes)
{
    uint8_t *p = malloc(bytes + 2 * GUARD_BYTES);
    assert_non_null(p);
    memset(p, GUARD, bytes + 2 * GUARD_BYTES);
    return p + GUARD_BYTES;
}

static void check_guards(const void *plane, size_t bytes)
{
    const uint8_t *p = plane;
    for (size_t i = 0; i < GUARD_BYTES; i++) {
        assert_int_equal(p[bytes + i], GUARD);
        assert_int_equal(*(p - 1 - i), GUARD);
    }
}

static void guarded_free(void *plane)
{
    if (plane != NULL) {
        free((uint8_t *)plane - GUARD_BYTES);
    }
}

void load_scene(t3r_runtime *rt, const t3r_scene_frame *frame, const t3r_gaussian *gaussians, size_t count)
{
    assert_int_equal(t3r_scene_begin(rt, frame), T3R_OK);
    for (size_t i = 0; i < count; i++) {
        assert_int_equal(t3r_scene_append(rt, &gaussians[i]), T3R_OK);
    }
}

drawing draw(t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height)
{
    size_t pixels = (size_t)width * height;
    drawing d = {width, height, guarded(pixels * 3), guarded(pixels * 4), guarded(pixels * 2), 0};
    t3r_target target = {
        .width = width,
        .height = height,
        .rgb = d.rgb,
        .rgb_stride_bytes = width * 3,
        .depth_q20 = d.depth_q20,
        .depth_stride_bytes = width * 4,
        .alpha_q15 = d.alpha_q15,
        .alpha_stride_bytes = width * 2,
    };
    assert_int_equal(t3r_render(rt, camera, &target), T3R_OK);
    check_guards(d.rgb, pixels * 3);
    check_guards(d.depth_q20, pixels * 4);
    check_guards(d.alpha_q15, pixels * 2);
    d.passes = t3r_render_passes(rt);
    return d;
}

drawing draw_scene(const t3r_scene_frame *frame, const t3r_gaussian *gaussians, size_t count, const t3r_camera *camera,
                   uint32_t width, uint32_t height, int arena_size)
{
    t3r_config config = render_config(count == 0 ? 1 : (uint32_t)count, width, height);
    arena a = arena_of(&config, arena_size);
    t3r_runtime *rt = NULL;
    assert_int_equal(t3r_init(&rt, a.bytes, a.count, &config), T3R_OK);
    load_scene(rt, frame, gaussians, count);
    drawing d = draw(rt, camera, width, height);
    arena_free(&a);
    return d;
}

void drawing_free(drawing *d)
{
    guarded_free(d->rgb);
    guarded_free(d->depth_q20);
    guarded_free(d->alpha_q15);
    *d = (drawing){0};
}

int drawing_equal(const drawing *a, const drawing *b)
{
    size_t pixels = (size_t)a->width * a->height;
    return a->width == b->width && a->height == b->height && memcmp(a->rgb, b->rgb, pixels * 3) == 0 &&
           memcmp(a->depth_q20, b->depth_q20, pixels * 4) == 0 && memcmp(a->alpha_q15, b->alpha_q15, pixels * 2) == 0;
}

static uint64_t dice_next(dice *d)
{
    d->state ^= d->state >> 12;
    d->state ^= d->state << 25;
    d->state ^= d->state >> 27;
    return d->state * UINT64_C(0x2545f4914f6cdd1d);
}

uint32_t dice_below(dice *d, uint32_t bound)
{
    return (uint32_t)(((dice_next(d) >> 32) * bound) >> 32);
}

double dice_between(dice *d, double low, double high)
{
    return low + (high - low) * ldexp((double)(dice_next(d) >> 11), -53);
}

void set_factor(t3r_gaussian *g, const double f[9])
{
    double most = 0;
    for (int i = 0; i < 9; i++) {
        most = fmax(most, fabs(f[i]));
    }
    int exponent = -60;
    while (exponent < 15 && nearbyint(ldexp(most, -exponent)) > 32767) {
        exponent++;
    }
    for (int i = 0; i < 9; i++) {
        g->factor[i] = (int16_t)nearbyint(ldexp(f[i], -exponent));
    }
    g->factor_exponent = (int8_t)exponent;
}

static uint16_t colour_q7(double c)
{
    return (uint16_t)nearbyint(c * 32640);
}

t3r_gaussian round_gaussian(double x, double y, double z, double sigma, double opacity, double r, double g, double b)
{
    t3r_gaussian gaussian = {
        .position_q20 = {(int32_t)nearbyint(ldexp(x, 20)), (int32_t)nearbyint(ldexp(y, 20)),
                         (int32_t)nearbyint(ldexp(z, 20))},
        .colour_q7 = {colour_q7(r), colour_q7(g), colour_q7(b)},
        .opacity_q15 = (uint16_t)fmin(32767, nearbyint(ldexp(opacity, 15))),
        .confidence = 255,
    };
    const double f[9] = {sigma, 0, 0, 0, sigma, 0, 0, 0, sigma};
    set_factor(&gaussian, f);
    return gaussian;
}

static void rotation_of(const double q[4], double r[9])
{
    /* columns are the images of the axes: v + 2 w (u x v) + 2 u x (u x v), q = (w, u) of norm 1 */
    for (int k = 0; k < 3; k++) {
        double v[3] = {k == 0, k == 1, k == 2};
        double c[3], cc[3];
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, l = (i + 2) % 3;
            c[i] = q[1 + j] * v[l] - q[1 + l] * v[j];
        }
        for (int i = 0; i < 3; i++) {
            int j = (i + 1) % 3, l = (i + 2) % 3;
            cc[i] = q[1 + j] * c[l] - q[1 + l] * c[j];
            r[i * 3 + k] = v[i] + 2 * (q[0] * c[i] + cc[i]);
        }
    }
}

void random_factor(dice *d, const double sigma[3], double f[9])
{
    double q[4], norm = 0, r[9];
    while (norm < 0.01 || norm > 1) {
        norm = 0;
        for (int i = 0; i < 4; i++) {
            q[i] = dice_between(d, -1, 1);
            norm += q[i] * q[i];
        }
    }
    for (int i = 0; i < 4; i++) {
        q[i] /= sqrt(norm);
    }
    rotation_of(q, r);
    for (int i = 0; i < 9; i++) {
        f[i] = r[i] * sigma[i % 3];
    }
}

t3r_camera plain_camera(double focal, uint32_t width, uint32_t height)
{
    return (t3r_camera){
        .fx_q16 = (int32_t)nearbyint(ldexp(focal, 16)),
        .fy_q16 = (int32_t)nearbyint(ldexp(focal, 16)),
        .cx_q16 = (int32_t)((width - 1) << 15),
        .cy_q16 = (int32_t)((height - 1) << 15),
        .rotation_q30 = {1 << 30, 0, 0, 0},
    };
}

t3r_camera camera_towards(double focal, uint32_t width, uint32_t height, const double position[3], const double at[3])
{
    t3r_camera camera = plain_camera(focal, width, height);
    double d[3] = {at[0] - position[0], at[1] - position[1], at[2] - position[2]};
    /* yaw about y, then pitch about the turned x: rotation = Ry(yaw) Rx(pitch), +z to the direction */
    double yaw = atan2(d[0], d[2]), pitch = atan2(-d[1], hypot(d[0], d[2]));
    double q[4] = {cos(yaw / 2) * cos(pitch / 2), cos(yaw / 2) * sin(pitch / 2), sin(yaw / 2) * cos(pitch / 2),
                   -sin(yaw / 2) * sin(pitch / 2)};
    for (int i = 0; i < 4; i++) {
        camera.rotation_q30[i] = (int32_t)nearbyint(ldexp(q[i], 30));
    }
    for (int i = 0; i < 3; i++) {
        camera.position_q32[i] = (int64_t)nearbyint(ldexp(position[i], 32));
    }
    return camera;
}
