/* SPDX-License-Identifier: Apache-2.0 */
/* The pointmap: x, y, z in the scene frame and surface tangents of every valid pixel. It is a function of the depth
 * plane, evaluated where needed, which saves twelve bytes a pixel. */
#ifndef T3R_POINTMAP_H
#define T3R_POINTMAP_H

#include <stdbool.h>
#include <stdint.h>

#include "core/scene_frame.h"
#include "state/views.h"

/* Prepared constants for back-projecting a view. */
typedef struct t3r_pointmap {
    const t3r_view *view;
    t3r_depth_scale scale;
    int32_t inverse_fx_q32, inverse_fy_q32; /* at most 2^29 */
} t3r_pointmap;

t3r_pointmap t3r_pointmap_of(const t3r_view *view, int32_t exponent);
void t3r_pointmaps_of(const t3r_view *views, uint32_t count, int32_t exponent, t3r_pointmap maps[T3R_MAX_VIEWS]);

/* Computes the direction of pixel (u, v)'s ray at unit depth in the camera frame: x and y, Q24, clamped to +-16 (z is
 * 1). */
void t3r_ray_q24(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t ray_q24[2]);

/* Computes the pixel's point, scene units. Returns false where there is no depth. */
bool t3r_point(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t point_q20[3]);

/* Computes the change of depth a pixel to the right and down, Q20, from neighbours on the same surface. It is 0 across
 * depth edges and without neighbours, and clamped to a slant of about 80 degrees. */
void t3r_slopes(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t slope_q20[2]);

/* Computes the tangents dX/du and dX/dv, scene units a pixel in Q24, in scene axes. Returns false where there is no
 * depth. */
bool t3r_tangents(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t tangent_u_q24[3], int32_t tangent_v_q24[3]);

#endif
