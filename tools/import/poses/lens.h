/* SPDX-License-Identifier: Apache-2.0 */
/* A camera's lens in doubles, both ways: for registration, before fixed point. */
#ifndef TRIM3R_TOOLS_LENS_H
#define TRIM3R_TOOLS_LENS_H

#include <stdbool.h>

#include "messages/ros_messages.h"
#include "trim3r.h"

typedef enum lens_model {
    LENS_PINHOLE,
    LENS_RATIONAL, /* k1 k2 p1 p2 k3 k4 k5 k6: plumb_bob has the first five */
    LENS_EQUIDISTANT
} lens_model;

typedef struct lens {
    double width, height; /* of the picture */
    double fx, fy, cx, cy;
    lens_model model;
    double d[8];
    double radius_most; /* radius of the picture's corners, in units of the focal length, plus a margin */
} lens;

/* Returns NULL, or what is wrong. */
const char *lens_of_info(const t3r_ros_camera_info *info, lens *out);
void lens_of_camera(const t3r_camera *camera, uint32_t width, uint32_t height, lens *out);
/* Adapts a lens to the picture of which each square of n x n pixels became one. */
void lens_reduce(lens *l, uint32_t n);
/* Projects a point in the camera's frame to a pixel; false for points behind the camera and far outside the picture,
 * where polynomials fold. */
bool lens_project(const lens *l, const double point[3], double pixel[2]);
/* Computes the point at depth 1 that pixel (u, v) sees. */
void lens_ray(const lens *l, double u, double v, double ray[2]);

#endif
