/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/seen.h"

#include <math.h>
#include <stdbool.h>
#include <stddef.h>

#include "core/camera.h"

#define WITHIN (1.0 / 20)

/* A pinhole camera in floats. */
typedef struct pinhole {
    double fx, fy, cx, cy, rotation[9], position[3]; /* rotation: camera to world, by rows */
} pinhole;

static pinhole pinhole_of(const t3r_camera *camera)
{
    pinhole p = {.fx = ldexp(camera->fx_q16, -16),
                 .fy = ldexp(camera->fy_q16, -16),
                 .cx = ldexp(camera->cx_q16, -16),
                 .cy = ldexp(camera->cy_q16, -16)};
    int32_t rotation_q30[9];
    t3r_camera_rotation(camera->rotation_q30, rotation_q30);
    for (int i = 0; i < 9; i++) {
        p.rotation[i] = ldexp(rotation_q30[i], -30);
    }
    for (int i = 0; i < 3; i++) {
        p.position[i] = ldexp((double)camera->position_q32[i], -32);
    }
    return p;
}

static void point_of(const pinhole *p, double u, double v, double z, double point[3])
{
    const double ray[3] = {(u - p->cx) / p->fx * z, (v - p->cy) / p->fy * z, z};
    for (int i = 0; i < 3; i++) {
        const double *row = &p->rotation[3 * (size_t)i];
        point[i] = row[0] * ray[0] + row[1] * ray[1] + row[2] * ray[2] + p->position[i];
    }
}

/* Returns a point in the camera's own frame. */
static void into(const pinhole *p, const double point[3], double own[3])
{
    for (size_t i = 0; i < 3; i++) {
        own[i] = 0;
        for (size_t k = 0; k < 3; k++) {
            own[i] += p->rotation[3 * k + i] * (point[k] - p->position[k]);
        }
    }
}

/* Whether the view measured depth z at (x, y) or beside it. */
static bool measured(const seen_view *view, uint32_t width, uint32_t height, long x, long y, double z)
{
    for (long v = y - 1; v <= y + 1; v++) {
        for (long u = x - 1; u <= x + 1; u++) {
            const bool inside = u >= 0 && v >= 0 && u < (long)width && v < (long)height;
            const double depth = inside ? view->depth[(size_t)v * width + (size_t)u] * view->unit : 0;
            if (depth > 0 && fabs(depth - z) <= z * WITHIN) {
                return true;
            }
        }
    }
    return false;
}

static bool saw(const seen_view *view, uint32_t width, uint32_t height, const double point[3])
{
    const pinhole p = pinhole_of(view->camera);
    double own[3];
    into(&p, point, own);
    if (own[2] <= 0) {
        return false;
    }
    const double x = p.fx * own[0] / own[2] + p.cx, y = p.fy * own[1] / own[2] + p.cy;
    const bool inside = x > -0.5 && y > -0.5 && x < width - 0.5 && y < height - 0.5;
    return inside && measured(view, width, height, lround(x), lround(y), own[2]);
}

void seen_mask(uint8_t *seen, uint32_t width, uint32_t height, const seen_view *target, const seen_view *context,
               uint32_t context_count)
{
    const pinhole p = pinhole_of(target->camera);
    for (uint32_t v = 0; v < height; v++) {
        for (uint32_t u = 0; u < width; u++) {
            const size_t i = (size_t)v * width + u;
            double point[3];
            seen[i] = 0;
            point_of(&p, u, v, target->depth[i] * target->unit, point);
            for (uint32_t c = 0; c < context_count && target->depth[i] != 0 && seen[i] == 0; c++) {
                seen[i] = saw(&context[c], width, height, point) ? 255 : 0;
            }
        }
    }
}
