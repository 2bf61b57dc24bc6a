/* SPDX-License-Identifier: Apache-2.0 */
/* Renders Gaussians as depth: what a depth camera at a view would measure of the means of a scene made elsewhere. */
#ifndef TRIM3R_TOOLS_SPLAT_DEPTH_H
#define TRIM3R_TOOLS_SPLAT_DEPTH_H

#include <stdbool.h>
#include <stdint.h>

#include "scene/scene_file.h"
#include "trim3r.h"

#define SPLAT_DEPTH_OPACITY_Q15 1638u /* 0.05; fainter Gaussians are no surface */
#define SPLAT_DEPTH_SURFACE                                                                                            \
    0.0625 /* relative to the depth: means up to this distance after the foremost belong to its surface */
#define SPLAT_DEPTH_MEDIANS 32 /* depths beyond this many median depths are clamped */

/* The depth plane of a frame. */
typedef struct splat_depth {
    uint8_t *steps;    /* width x height x 2, heap: little-endian 16-bit steps along the camera's z; 0 = no mean */
    uint64_t unit_q40; /* world units per step, as in t3r_frame: the median has at least 2047 steps */
    uint32_t seen;     /* pixels with a depth */
} splat_depth;

/* Gives each pixel the depth of a mean that projects into it: on the foremost surface, the one nearest to the pixel's
 * centre, which in a view of a pixel-aligned set is that pixel's own. Gaussians behind the camera, outside the picture
 * or too faint are ignored. `camera` is without distortion, the sides at most T3R_MAX_SIDE. False without memory;
 * free(out->steps) in either case. Host floats: bits are not guaranteed. */
bool splat_depth_make(splat_depth *out, const scene_file *scene, const t3r_camera *camera, uint32_t width,
                      uint32_t height);

#endif
