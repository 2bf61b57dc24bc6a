/* SPDX-License-Identifier: Apache-2.0 */
#include "geometry/pinhole.h"

#include <math.h>
#include <stddef.h>
#include <stdint.h>

#include "core/camera.h"

pinhole pinhole_of(const t3r_camera *camera)
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

void pinhole_point(const pinhole *p, double u, double v, double z, double point[3])
{
    const double ray[3] = {(u - p->cx) / p->fx * z, (v - p->cy) / p->fy * z, z};
    for (int i = 0; i < 3; i++) {
        const double *row = &p->rotation[3 * (size_t)i];
        point[i] = row[0] * ray[0] + row[1] * ray[1] + row[2] * ray[2] + p->position[i];
    }
}

bool pinhole_project(const pinhole *p, const double point[3], double pixel[2], double *z)
{
    double own[3];
    for (size_t i = 0; i < 3; i++) {
        own[i] = 0;
        for (size_t k = 0; k < 3; k++) {
            own[i] += p->rotation[3 * k + i] * (point[k] - p->position[k]);
        }
    }
    *z = own[2];
    pixel[0] = own[2] > 0 ? p->fx * own[0] / own[2] + p->cx : 0;
    pixel[1] = own[2] > 0 ? p->fy * own[1] / own[2] + p->cy : 0;
    return own[2] > 0;
}
