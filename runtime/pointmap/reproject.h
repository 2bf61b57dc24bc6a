/* A pixel of one view sought in another. */
#ifndef T3R_REPROJECT_H
#define T3R_REPROJECT_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "pointmap.h"

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
