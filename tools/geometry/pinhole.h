/* SPDX-License-Identifier: Apache-2.0 */
/* A camera without distortion, in doubles: for comparing views, where no bit of a result depends on it. */
#ifndef TRIM3R_TOOLS_PINHOLE_H
#define TRIM3R_TOOLS_PINHOLE_H

#include <stdbool.h>

#include "trim3r.h"

typedef struct pinhole {
    double fx, fy, cx, cy, rotation[9], position[3]; /* rotation: camera to world, by rows */
} pinhole;

/* Converts a camera, whose distortion is ignored. */
pinhole pinhole_of(const t3r_camera *camera);

/* Returns in point[] the world's point at pixel (u, v), (0, 0) being the centre of the first, and depth z. */
void pinhole_point(const pinhole *p, double u, double v, double z, double point[3]);

/* Projects a point of the world to a pixel and its depth. Returns false if it is not in front of the camera. */
bool pinhole_project(const pinhole *p, const double point[3], double pixel[2], double *z);

#endif
