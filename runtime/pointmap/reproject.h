/* Projection of one view's pixels into another view. */
#ifndef T3R_REPROJECT_H
#define T3R_REPROJECT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/points.h"
#include "pointmap.h"

/* Return a view and its pointmap in the form that kernels take. */
t3r_pinhole t3r_pinhole_of(const t3r_view *view);
t3r_unprojection t3r_unprojection_of(const t3r_pointmap *map);

/* Appends pixel (u, v) of the view to a batch, which has room for T3R_POINTS. */
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

/* Position of a point in another view. */
typedef struct t3r_projected_pixel {
    size_t pixel;  /* the pixel whose centre is nearest */
    int32_t z_q20; /* the point's depth there, scene units, at least 1/32 */
} t3r_projected_pixel;

/* Projects a point (scene units) into the view. Returns false when it is nearer than 1/32 scene unit there, more than
 * 16 z aslant or outside the image. */
bool t3r_project_to_pixel(const t3r_view *view, const int32_t point_q20[3], t3r_projected_pixel *projected);

/* Projects pixel (u, v) of `from` into `to`. Returns false where the pixel has no depth, or its point is nearer than
 * 1/32 scene unit there, more than 16 z aslant or outside the image. */
bool t3r_reproject(const t3r_pointmap *from, uint32_t u, uint32_t v, const t3r_pointmap *to,
                   t3r_projected_pixel *projected);

#endif
