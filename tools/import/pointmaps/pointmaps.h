/* SPDX-License-Identifier: Apache-2.0 */
/* Pointmaps made elsewhere (DUSt3R, MASt3R, VGGT ...): the 3D point that each pixel of a view shows, for all views of a
 * file in one frame, with a confidence per pixel, and what is known of the cameras.
 *
 * A .npz holds these arrays, each under the first of its names that the file has:
 *   pts3d, world_points, points, pointmap   float32, N x H x W x 3 (or H x W x 3; a leading 1 may stand before)
 *   conf, confs, world_points_conf, confidence   float32, N x H x W: as the points', without the 3; may be missing
 *   poses   N x 4 x 4: camera to the points' frame; or
 *   extrinsics, extrinsic   N x 3 x 4 or N x 4 x 4: the points' frame to camera; may be missing
 *   intrinsics, intrinsic   N x 3 x 3, pixels of the map, (0, 0) being the centre of the top-left one; or
 *   focals   N, the principal point at (W / 2, H / 2); may be missing
 * Camera axes are x right, y down, z forward. A .npy holds only the points. */
#ifndef TRIM3R_TOOLS_POINTMAPS_H
#define TRIM3R_TOOLS_POINTMAPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry/rigid.h"
#include "pictures/picture.h"

/* An open file: the data that all views share, and one view's numbers at a time. */
typedef struct pointmaps {
    uint32_t count, width, height;
    rigid *poses;            /* camera to the points' frame; NULL = none */
    double (*intrinsics)[4]; /* fx fy cx cy in pixels of the map; NULL = none */
    bool has_confidence;
    float *points;     /* height x width x 3 of the current view, all finite; NULL = none read */
    float *confidence; /* height x width of the view, all finite; NULL = the file has none */
    struct pointmaps_input *input;
} pointmaps;

/* Opens a .npz or .npy, which its contents identify, and reads all but points and confidence. confidence (may be NULL):
 * a .npy that holds them. Returns 0, or -1 with "path: array: what" in error[]; call pointmaps_free() in either
 * case. */
int pointmaps_open(const char *path, const char *confidence, pointmaps *out, char *error, size_t error_bytes);
/* The same for memory, which must outlive it; the reason is "array: what". */
int pointmaps_parse(const uint8_t *bytes, size_t count, pointmaps *out, char *error, size_t error_bytes);

/* Reads the points and the confidence of view `index`, replacing the previous view: cheap for a later view. Returns 0,
 * or -1 with what is wrong in error[]. */
int pointmaps_read(pointmaps *maps, uint32_t index, char *error, size_t error_bytes);
/* Frees the current view. */
void pointmaps_forget(pointmaps *maps);
void pointmaps_free(pointmaps *maps);

/* Computes the depth along z of a camera for every point of the current view, 0 where the confidence is below `least`.
 * camera: to the points' frame. depth: height x width. */
void pointmaps_depth(const pointmaps *maps, const rigid *camera, double least, float *depth);

#endif
