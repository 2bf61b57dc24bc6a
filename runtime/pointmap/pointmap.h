/* The pointmap: every valid pixel to x, y, z in the scene frame, with its surface tangents. It is a function of the
 * depth plane, evaluated where it is needed: twelve bytes a pixel saved, and nothing to keep in step. */
#ifndef T3R_POINTMAP_H
#define T3R_POINTMAP_H

#include <stdbool.h>
#include <stdint.h>

#include "core/scene_frame.h"
#include "state/views.h"

/* A view's back-projection, prepared once. */
typedef struct t3r_pointmap {
    const t3r_view *view;
    t3r_depth_scale scale;
    int32_t inverse_fx_q32, inverse_fy_q32; /* at most 2^29 */
} t3r_pointmap;

t3r_pointmap t3r_pointmap_of(const t3r_view *view, int32_t exponent);
void t3r_pointmaps_of(const t3r_view *views, uint32_t count, int32_t exponent, t3r_pointmap maps[T3R_MAX_VIEWS]);

/* The direction of pixel (u, v)'s ray at unit depth, camera frame: x and y, Q24, held within +-16 (z is 1). */
void t3r_ray_q24(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t ray_q24[2]);

/* The pixel's point, scene units; false where there is no depth. */
bool t3r_point(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t point_q20[3]);

/* Change of depth a pixel to the right and down, Q20, from the neighbours on the same surface: 0 across depth edges
 * and where there are none; held so that the surface is never seen more than about 80 degrees aslant. */
void t3r_slopes(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t slope_q20[2]);

/* The two tangents dX/du and dX/dv, scene units a pixel in Q24, scene axes. False where there is no depth. */
bool t3r_tangents(const t3r_pointmap *map, uint32_t u, uint32_t v, int32_t tangent_u_q24[3], int32_t tangent_v_q24[3]);

#endif
