/* Pixels of one view sought in another. */
#ifndef T3R_REPROJECT_H
#define T3R_REPROJECT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/points.h"
#include "pointmap.h"

/* A view as kernels have it, and its pointmap. */
t3r_pinhole t3r_pinhole_of(const t3r_view *view);
t3r_unprojection t3r_unprojection_of(const t3r_pointmap *map);

/* Enters pixel (u, v) of the view; there is room for T3R_POINTS of them. */
static inline void t3r_add_pixel(t3r_points *points, const t3r_view *view, uint32_t u, uint32_t v)
{
    const uint32_t i = points->count++;
    points->u[i] = (uint16_t)u;
    points->v[i] = (uint16_t)v;
    points->depth[i] = view->depth[(size_t)v * view->width + u];
}

static inline bool t3r_is_full(const t3r_points *points)
{
    return points->count == T3R_POINTS;
}

/* Where a point falls in another view. */
typedef struct t3r_projected_pixel {
    size_t pixel;  /* the pixel whose centre is nearest */
    int32_t z_q20; /* the point's depth there, scene units, at least 1/32 */
} t3r_projected_pixel;

/* Where the view sees the point (scene units). False when it is nearer than 1/32 scene unit there, more than 16 z
 * aslant or outside the image. */
bool t3r_project_to_pixel(const t3r_view *view, const int32_t point_q20[3], t3r_projected_pixel *projected);

/* Follows pixel (u, v) of `from` into `to`. False where the pixel has no depth, and where its point is nearer than 1/32
 * scene unit there, more than 16 z aslant or outside the image. */
bool t3r_reproject(const t3r_pointmap *from, uint32_t u, uint32_t v, const t3r_pointmap *to,
                   t3r_projected_pixel *projected);

#endif
