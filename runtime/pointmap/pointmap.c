#include "pointmap.h"

#include "depth/depth.h"
#include "core/fixed.h"
#include "kernels/points_parts.h"

/* Distance of the farthest neighbour in the slope, pixels. */
#define REACH 2
/* tan 80 degrees, Q4 */
#define SLANT_MOST_Q4 91

t3r_pointmap t3r_pointmap_of(const t3r_view *view, int32_t exponent)
{
    return (t3r_pointmap){
        .view = view,
        .scale = t3r_depth_scale_of(view->depth_unit_q40, exponent),
        .inverse_fx_q32 = (int32_t)(((int64_t)1 << 48) / view->fx_q16),
        .inverse_fy_q32 = (int32_t)(((int64_t)1 << 48) / view->fy_q16),
    };
}

void t3r_pointmaps_of(const t3r_view *views, uint32_t count, int32_t exponent, t3r_pointmap maps[T3R_MAX_VIEWS])
{
    for (uint32_t v = 0; v < count; v++) {
        maps[v] = t3r_pointmap_of(&views[v], exponent);
    }
}

void t3r_ray_q24(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t ray_q24[2])
{
    ray_q24[0] = t3r_ray_along_q24(u, map->view->cx_q16, map->inverse_fx_q32);
    ray_q24[1] = t3r_ray_along_q24(v, map->view->cy_q16, map->inverse_fy_q32);
}

/* Rotates a camera-frame vector into the scene, Q24 in and out: |v| <= 2^30 sqrt 3, so the sums stay below 2^61. */
static void to_scene(const int32_t *r_q30, const int64_t v[3], int64_t out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = t3r_round_shift64(r_q30[3 * i] * v[0] + r_q30[3 * i + 1] * v[1] + r_q30[3 * i + 2] * v[2], 30);
    }
}

bool t3r_point(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t point_q20[3])
{
    const t3r_view *view = map->view;
    size_t pixel = (size_t)v * view->width + u;
    if (!t3r_has_depth(view->validity[pixel])) {
        return false;
    }
    int32_t ray[2];
    t3r_ray_q24(map, u, v, ray);
    t3r_point_along(&view->pose, ray, t3r_depth_q20(map->scale, view->depth[pixel]), point_q20);
    return true;
}

/* Returns the mean slope along one axis over the neighbours on the pixel's surface, up to REACH pixels away, with both
 * sides weighted alike. */
static int32_t slope_along(const t3r_pointmap *map, size_t pixel, uint32_t at, uint32_t length, size_t stride)
{
    const t3r_view *view = map->view;
    int32_t here = t3r_depth_q20(map->scale, view->depth[pixel]);
    int64_t rise = 0, run = 0; /* least squares through the pixel: sum(t dz) / sum(t^2) */
    for (int side = -1; side <= 1; side += 2) {
        for (int32_t t = 1; t <= REACH; t++) {
            if (side < 0 ? at < (uint32_t)t : at + (uint32_t)t >= length) {
                break;
            }
            size_t neighbour = side < 0 ? pixel - (size_t)t * stride : pixel + (size_t)t * stride;
            if (!t3r_has_depth(view->validity[neighbour]) ||
                !t3r_same_surface(view->depth[pixel], view->depth[neighbour])) {
                break;
            }
            int32_t change = t3r_depth_q20(map->scale, view->depth[neighbour]) - here;
            rise += (int64_t)(side * t) * change;
            run += t * t;
        }
    }
    return run == 0 ? 0 : (int32_t)(rise / run);
}

void t3r_slopes(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t slope_q20[2])
{
    const t3r_view *view = map->view;
    size_t pixel = (size_t)v * view->width + u;
    slope_q20[0] = slope_along(map, pixel, u, view->width, 1);
    slope_q20[1] = slope_along(map, pixel, v, view->height, view->width);
    /* A pixel is z / f wide; slopes are clamped to tan 80 degrees times that. z < 2^30, 1/f < 2^29 in Q32. */
    int64_t z = t3r_depth_q20(map->scale, view->depth[pixel]);
    int64_t most_u = t3r_round_shift64(z * map->inverse_fx_q32, 32) * SLANT_MOST_Q4 >> 4;
    int64_t most_v = t3r_round_shift64(z * map->inverse_fy_q32, 32) * SLANT_MOST_Q4 >> 4;
    slope_q20[0] = (int32_t)t3r_clamp64(slope_q20[0], -most_u, most_u);
    slope_q20[1] = (int32_t)t3r_clamp64(slope_q20[1], -most_v, most_v);
}

bool t3r_tangents(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t tangent_u_q24[3], int32_t tangent_v_q24[3])
{
    const t3r_view *view = map->view;
    size_t pixel = (size_t)v * view->width + u;
    if (!t3r_has_depth(view->validity[pixel])) {
        return false;
    }
    int32_t ray[2], slope[2];
    t3r_ray_q24(map, u, v, ray);
    t3r_slopes(map, u, v, slope);
    int64_t z = t3r_depth_q20(map->scale, view->depth[pixel]);
    /* X = z (x, y, 1): dX/du = (z / fx, 0, 0) + dz/du (x, y, 1), Q24: below 2^38, then clamped. */
    int64_t across = t3r_round_shift64(z * map->inverse_fx_q32, 28);
    int64_t down = t3r_round_shift64(z * map->inverse_fy_q32, 28);
    int64_t du[3] = {across + t3r_round_shift64((int64_t)slope[0] * ray[0], 20),
                     t3r_round_shift64((int64_t)slope[0] * ray[1], 20), (int64_t)slope[0] * 16};
    int64_t dv[3] = {t3r_round_shift64((int64_t)slope[1] * ray[0], 20),
                     down + t3r_round_shift64((int64_t)slope[1] * ray[1], 20), (int64_t)slope[1] * 16};
    int64_t su[3], sv[3];
    for (int i = 0; i < 3; i++) {
        /* 64 scene units a pixel is wider than any surface trim3r can draw. */
        du[i] = t3r_clamp64(du[i], -((int64_t)1 << 30), (int64_t)1 << 30);
        dv[i] = t3r_clamp64(dv[i], -((int64_t)1 << 30), (int64_t)1 << 30);
    }
    to_scene(view->pose.rotation_q30, du, su);
    to_scene(view->pose.rotation_q30, dv, sv);
    for (int i = 0; i < 3; i++) {
        tangent_u_q24[i] = (int32_t)su[i]; /* at most 2^30 sqrt 3 */
        tangent_v_q24[i] = (int32_t)sv[i];
    }
    return true;
}
