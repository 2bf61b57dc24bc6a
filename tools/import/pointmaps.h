/* Pointmaps made elsewhere (DUSt3R, MASt3R, VGGT ...): for every pixel of a view the place that it shows, all views of
 * a file in one frame, with a confidence a pixel, and what the maker knows of the cameras.
 *
 * A .npz holds, under the first of these names that it has,
 *   pts3d, world_points, points, pointmap   float32, N x H x W x 3 (or H x W x 3; a leading 1 may stand before)
 *   conf, confs, world_points_conf, confidence   float32, N x H x W: as the points', without the 3; may be missing
 *   poses   N x 4 x 4: camera to the points' frame; or
 *   extrinsics, extrinsic   N x 3 x 4 or N x 4 x 4: the points' frame to camera; may be missing
 *   intrinsics, intrinsic   N x 3 x 3, pixels of the map, (0, 0) being the centre of the top-left one; or
 *   focals   N, the principal point at (W / 2, H / 2); may be missing
 * with camera axes x right, y down, z forward. A .npy holds the points alone. */
#ifndef TRIM3R_TOOLS_POINTMAPS_H
#define TRIM3R_TOOLS_POINTMAPS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "pictures/picture.h"
#include "posing/motion.h"

#define POINTMAPS_MOST 1000u

typedef struct pointmaps {
    uint32_t count, width, height;
    float *points;           /* count x height x width x 3, all finite */
    float *confidence;       /* count x height x width, all finite; NULL = none */
    motion *poses;           /* camera to the points' frame; NULL = none */
    double (*intrinsics)[4]; /* fx fy cx cy in pixels of the map; NULL = none */
} pointmaps;

/* Reads a .npz or .npy (told by what it holds). 0, or -1 with "array: what" in error[]; pointmaps_free() in either
 * case. */
int pointmaps_parse(const uint8_t *bytes, size_t count, pointmaps *out, char *error, size_t error_bytes);
/* The same from a file, with "path: array: what"; confidence (may be NULL): a .npy with them. */
int pointmaps_read(const char *path, const char *confidence, pointmaps *out, char *error, size_t error_bytes);
void pointmaps_free(pointmaps *maps);

/* Depth of every point of map `index` along z of a camera, 0 where its confidence is below `least`. camera: to the
 * points' frame. depth: height x width. */
void pointmaps_depth(const pointmaps *maps, uint32_t index, const motion *camera, double least, float *depth);

#endif
