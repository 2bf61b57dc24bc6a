/* SPDX-License-Identifier: Apache-2.0 */
/* Pixels to points, and points to pixels. */
#include "checks.h"
#include "guarded.h"

__extension__ typedef __int128 int128;

/* Makes a rotation about an axis with few bits, or any entries of at most 1: no check needs a true rotation. */
static void make_pinhole(t3r_pinhole *p, uint64_t *seed)
{
    const bool plain = unit_random(seed) % 2 == 0;
    for (int i = 0; i < 9; i++) {
        p->pose.rotation_q30[i] = plain ? (i % 4 == 0) << 30 : (int32_t)any_value(seed, -620000000, 620000000);
    }
    for (int i = 0; i < 3; i++) {
        const int32_t most = unit_random(seed) % 4 == 0 ? T3R_POSITION_MOST_Q20 : 4 << 20;
        p->pose.position_q20[i] = plain ? 0 : (int32_t)any_value(seed, -most, most);
    }
    const int32_t longest = unit_random(seed) % 2 == 0 ? 400 : 16383;
    p->fx_q16 = (int32_t)any_value(seed, 8 << 16, longest << 16);
    p->fy_q16 = plain ? 256 << 16 : (int32_t)any_value(seed, 8 << 16, longest << 16);
    p->cx_q16 = plain ? 128 << 16 : (int32_t)any_value(seed, -(16383 << 16), 16383 << 16);
    p->cy_q16 = (int32_t)any_value(seed, 0, 300 << 16);
    p->width = (uint32_t)unit_between(seed, 2, plain ? 300 : T3R_MAX_SIDE);
    p->height = (uint32_t)unit_between(seed, 2, plain ? 300 : T3R_MAX_SIDE);
}

static int64_t rounded(int64_t x, int shift)
{
    const int128 half = shift == 0 ? 0 : (int128)1 << (shift - 1);
    return (int64_t)((x + half) >> shift);
}

static int64_t held(int64_t x, int64_t most)
{
    return x > most ? most : x < -most ? -most : x;
}

const char *check_unproject(const t3r_kernels *kernels, uint64_t *seed)
{
    t3r_unprojection *from = guarded_take(sizeof *from, 8);
    t3r_points *points = guarded_take(sizeof *points, 4);
    make_pinhole(&from->view, seed);
    from->scale.mantissa = (uint32_t)any_value(seed, INT64_C(1) << 31, UINT32_MAX);
    from->scale.shift = (uint32_t)(unit_random(seed) % 2 == 0 ? unit_between(seed, 18, 30) : any_value(seed, 0, 62));
    from->inverse_fx_q32 = (int32_t)((INT64_C(1) << 48) / from->view.fx_q16);
    from->inverse_fy_q32 = (int32_t)((INT64_C(1) << 48) / from->view.fy_q16);
    memset(points, 0x7f, sizeof *points);
    points->count = any_length(seed, T3R_POINTS);
    for (uint32_t i = 0; i < points->count; i++) {
        points->u[i] = (uint16_t)any_value(seed, 0, T3R_MAX_SIDE - 1);
        points->v[i] = (uint16_t)any_value(seed, 0, T3R_MAX_SIDE - 1);
        points->depth[i] = (uint16_t)any_value(seed, 0, UINT16_MAX);
    }
    t3r_points before = *points;
    kernels->unproject(from, points);
    for (uint32_t i = 0; i < before.count; i++) {
        int64_t z = rounded((int64_t)before.depth[i] * from->scale.mantissa, (int)from->scale.shift);
        z = z < T3R_POSITION_MOST_Q20 ? z : T3R_POSITION_MOST_Q20 - 1;
        const int64_t far = 16 << 24;
        const int64_t x =
            held(rounded((((int64_t)before.u[i] << 16) - from->view.cx_q16) * from->inverse_fx_q32, 24), far);
        const int64_t y =
            held(rounded((((int64_t)before.v[i] << 16) - from->view.cy_q16) * from->inverse_fy_q32, 24), far);
        for (int k = 0; k < 3; k++) {
            const int32_t *r = from->view.pose.rotation_q30 + 3 * k;
            const int64_t direction = rounded(r[0] * x + r[1] * y + (int64_t)r[2] * (1 << 24), 30);
            const int64_t at = from->view.pose.position_q20[k] + rounded(direction * z, 24);
            before.point_q20[k][i] = (int32_t)held(at, T3R_POSITION_MOST_Q20);
            if (points->point_q20[k][i] != before.point_q20[k][i]) {
                return "a point differs";
            }
        }
    }
    return points->count == before.count && SAME(points->u, before.u, before.count) &&
                   SAME(points->v, before.v, before.count) && SAME(points->depth, before.depth, before.count)
               ? NULL
               : "an input changed";
}

/* floor(n / d + 1/2) */
static int64_t divided(int128 n, int64_t d)
{
    const int128 doubled = 2 * n + d, quotient = doubled / (2 * (int128)d);
    return (int64_t)(quotient - (doubled % (2 * (int128)d) < 0));
}

static int64_t pixel_along(int64_t x, int64_t z, int32_t focal_q16, int32_t centre_q16)
{
    const int64_t ratio_q24 = divided((int128)x * (1 << 24), z);
    return rounded(rounded(ratio_q24 * focal_q16, 24) + centre_q16, 16);
}

static uint32_t pixel_of(const t3r_pinhole *view, const int64_t camera[3])
{
    const int64_t z = camera[2];
    if (z < 1 << 15 || z > INT32_MAX || llabs(camera[0]) > 16 * z || llabs(camera[1]) > 16 * z) {
        return T3R_NO_PIXEL;
    }
    const int64_t column = pixel_along(camera[0], z, view->fx_q16, view->cx_q16);
    const int64_t row = pixel_along(camera[1], z, view->fy_q16, view->cy_q16);
    const bool inside = column >= 0 && row >= 0 && column < view->width && row < view->height;
    return inside ? (uint32_t)(row * view->width + column) : T3R_NO_PIXEL;
}

/* Makes a point on the border between two pixels or next to it, for a view without rotation. */
static void between_pixels(const t3r_pinhole *view, uint64_t *seed, int32_t point[3])
{
    const int64_t z = INT64_C(1) << unit_between(seed, 15, 29), f = view->fx_q16;
    const int64_t column = unit_between(seed, -1, (int64_t)view->width);
    const int64_t x = ((2 * column + 1) * (1 << 15) - view->cx_q16) * z / f + unit_between(seed, -1, 1);
    point[0] = (int32_t)held(x, T3R_POSITION_MOST_Q20);
    point[2] = (int32_t)z;
}

const char *check_locate(const t3r_kernels *kernels, uint64_t *seed)
{
    t3r_pinhole *view = guarded_take(sizeof *view, 4);
    t3r_points *points = guarded_take(sizeof *points, 4);
    t3r_places *places = guarded_take(sizeof *places, 4);
    make_pinhole(view, seed);
    memset(points, 0x7f, sizeof *points);
    points->count = any_length(seed, T3R_POINTS);
    for (uint32_t i = 0; i < points->count; i++) {
        const int64_t most = INT64_C(1) << unit_between(seed, 14, 30);
        int32_t point[3];
        for (int k = 0; k < 3; k++) {
            point[k] = (int32_t)any_value(seed, k == 2 ? 0 : -most, most);
        }
        if (unit_random(seed) % 3 == 0) {
            between_pixels(view, seed, point);
        }
        for (int k = 0; k < 3; k++) {
            points->point_q20[k][i] = point[k];
        }
    }
    kernels->locate(view, points, places);
    for (uint32_t i = 0; i < points->count; i++) {
        int64_t camera[3];
        for (int k = 0; k < 3; k++) {
            int128 sum = 1 << 29;
            for (int j = 0; j < 3; j++) {
                const int64_t offset = (int64_t)points->point_q20[j][i] - view->pose.position_q20[j];
                sum += (int128)view->pose.rotation_q30[3 * j + k] * offset;
            }
            camera[k] = (int64_t)(sum >> 30);
        }
        const uint32_t pixel = pixel_of(view, camera);
        if (places->pixel[i] != pixel) {
            return "a pixel differs";
        }
        if (pixel != T3R_NO_PIXEL && places->z_q20[i] != camera[2]) {
            return "a depth differs";
        }
    }
    return NULL;
}
