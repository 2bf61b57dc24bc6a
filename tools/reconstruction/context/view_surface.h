/* SPDX-License-Identifier: Apache-2.0 */
/* The surface that a frame sees, coarsely: its camera, a small grid of depths, and how sharp its picture is. */
#ifndef TRIM3R_TOOLS_VIEW_SURFACE_H
#define TRIM3R_TOOLS_VIEW_SURFACE_H

#include <stdbool.h>
#include <stdint.h>

#include "geometry/pinhole.h"
#include "recording/recording.h"

enum { SURFACE_ACROSS = 32, SURFACE_DOWN = 24, SURFACE_CELLS = SURFACE_ACROSS * SURFACE_DOWN };

typedef struct view_surface {
    pinhole camera; /* of a picture of width x height */
    uint32_t width, height;
    bool measured;               /* a sensor measured the depths; otherwise they are assumed */
    double depth[SURFACE_CELLS]; /* of each cell's middle, in world units; 0 = none */
    double sharpness;            /* fine detail by coarse detail; a blurred picture of the same things has less */
} view_surface;

/* Looks at a frame with pose and intrinsics; `path` and `index` name it in messages. by_sensor: takes the frame's
 * depth, if it has any. Returns an exit status of cli.h. */
int view_surface_make(view_surface *out, const t3r_capture_frame *frame, const char *path, uint32_t index,
                      bool by_sensor);

/* Assumes one depth for all cells of a surface that was not measured. */
void view_surface_assume(view_surface *surface, double depth);

/* Returns in point[] the world's point in the middle of a cell; false if its depth is unknown. */
bool view_surface_point(const view_surface *surface, uint32_t cell, double point[3]);

/* Whether the point lies in the picture, and not farther away than the surface that was measured there. */
bool view_surface_sees(const view_surface *surface, const double point[3]);

/* Returns the share of the points of `of` that `by` sees, too; 0 if none is known. */
double view_surface_shared(const view_surface *of, const view_surface *by);

/* Returns the median of the values, as the sharpness that pictures of a scene usually have. */
double view_sharpness_usual(const double *values, uint32_t count);
/* Whether a picture of that sharpness is blurred, against the usual one. */
bool view_sharpness_is_blurred(double sharpness, double usual);

#endif
