/* SPDX-License-Identifier: Apache-2.0 */
/* The surface around each Gaussian of a stream's map, as a keyframe sees it (SPEC.md, "Streams"). */
#ifndef T3R_STREAM_DISCS_H
#define T3R_STREAM_DISCS_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "core/workers.h"
#include "stream_map.h"

/* The pixels around a Gaussian's centre, and the depth steps of its surface. */
typedef struct t3r_map_disc {
    int16_t u, v; /* pixel of the centre, at most T3R_MAP_MARGIN outside the picture */
    uint16_t radius_q4;
    uint16_t surface;           /* pixels that show it, with all that lie outside the picture; 0: none in the picture */
    uint16_t nearest, farthest; /* depth steps, at least 1 */
    int32_t density_q10;        /* log2 of the noted density, a pixel of the keyframe */
} t3r_map_disc;

/* A row of a disc: `pixels` in all, of which `inside` lie in the picture, from `first` on. */
typedef struct t3r_disc_row {
    size_t first;
    uint32_t inside, pixels;
} t3r_disc_row;

/* Half the width of each row of a disc, by the row's distance from the centre. */
typedef struct t3r_disc_shape {
    uint8_t half[T3R_MAP_MARGIN + 1];
    int32_t radius;
} t3r_disc_shape;

t3r_disc_shape t3r_disc_shape_of(const t3r_map_disc *disc);

/* Returns row y, -radius..radius, of a disc. */
static inline t3r_disc_row t3r_disc_row_of(const t3r_view *view, const t3r_map_disc *disc, const t3r_disc_shape *shape,
                                           int32_t y)
{
    const int32_t half = shape->half[t3r_abs32(y)], row = disc->v + y;
    const int32_t begin = T3R_MAX(disc->u - half, 0), end = T3R_MIN(disc->u + half + 1, (int32_t)view->width);
    t3r_disc_row r = {.pixels = 2 * (uint32_t)half + 1};
    if (row >= 0 && row < (int32_t)view->height && begin < end) {
        r.first = (size_t)row * view->width + (size_t)begin;
        r.inside = (uint32_t)(end - begin);
    }
    return r;
}

/* Whether the pixel shows the disc's surface: any, where its own depth is bridged. */
static inline bool t3r_is_on_disc(const t3r_view *view, const t3r_map_disc *disc, size_t pixel)
{
    const uint32_t steps = view->depth[pixel];
    return ((steps >= disc->nearest) & (steps <= disc->farthest)) | t3r_is_bridged(view->validity[pixel]);
}

/* Finds the discs of all Gaussians of the map. */
void t3r_map_discs_find(const t3r_map *map, const t3r_pointmap *keyframe, const t3r_workers *workers,
                        t3r_map_disc *discs);

#endif
