/* SPDX-License-Identifier: Apache-2.0 */
/* Finds the planes of a view's matched pixels (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_SEARCH_H
#define T3R_PLANE_SEARCH_H

#include <stddef.h>
#include <stdint.h>

#include "core/fixed.h"
#include "depth/surface.h"
#include "state/views.h"

#define T3R_PLANES_MOST 8u

/* Cells and samples along a view's longer side: hypotheses come from cells and are counted on samples. */
#define T3R_PLANE_CELLS 16u
#define T3R_PLANE_SAMPLES 64u

/* One over depth, Q30 + 8, at the picture's middle, and its change per pixel to the right and down. */
typedef struct t3r_plane {
    int64_t middle_q8;
    int32_t x_q8, y_q8;
} t3r_plane;

/* Returns one over depth at a place relative to the picture's middle, Q30 + 8. */
static inline int64_t t3r_plane_at_q8(const t3r_plane *plane, int32_t x, int32_t y)
{
    return plane->middle_q8 + (int64_t)plane->x_q8 * x + (int64_t)plane->y_q8 * y;
}

/* A matched pixel. */
typedef struct t3r_plane_sample {
    int16_t x, y;
    int32_t inverse; /* one over depth, Q30 */
} t3r_plane_sample;

/* Samples lie in squares of as many a side, so that a square as a whole may be far from a plane. */
#define T3R_PLANE_SQUARE 8u
#define T3R_PLANE_SQUARES (T3R_PLANE_SAMPLES / T3R_PLANE_SQUARE * (T3R_PLANE_SAMPLES / T3R_PLANE_SQUARE))
typedef struct t3r_plane_square {
    int32_t x, y;        /* of its first sample */
    int32_t least, most; /* one over depth of all its samples, Q30 */
    uint32_t count;
    t3r_plane_sample sample[T3R_PLANE_SQUARE * T3R_PLANE_SQUARE]; /* on no plane found so far */
} t3r_plane_square;

typedef struct t3r_plane_hypothesis {
    t3r_plane plane;
    uint32_t samples; /* samples on it, */
    uint32_t planes;  /* without those on so many planes that were found first */
} t3r_plane_hypothesis;

/* Number of windows of one, four and nine cells */
#define T3R_PLANE_HYPOTHESES                                                                                           \
    (T3R_PLANE_CELLS * T3R_PLANE_CELLS + (T3R_PLANE_CELLS - 1) * (T3R_PLANE_CELLS - 1) +                               \
     (T3R_PLANE_CELLS - 2) * (T3R_PLANE_CELLS - 2))

/* Bytes of work, aligned to 64 */
#define T3R_PLANE_SEARCH_BYTES                                                                                         \
    (T3R_UP_(T3R_PLANE_CELLS * T3R_PLANE_CELLS * sizeof(t3r_surface_sums)) +                                           \
     T3R_UP_(T3R_PLANE_HYPOTHESES * sizeof(t3r_plane_hypothesis)) +                                                    \
     T3R_UP_(T3R_PLANE_SQUARES * sizeof(t3r_plane_square)) +                                                           \
     T3R_UP_(T3R_PLANE_CELLS * T3R_PLANE_CELLS * sizeof(uint32_t)))

typedef struct t3r_planes {
    uint32_t count;
    t3r_plane plane[T3R_PLANES_MOST]; /* by falling number of samples */
    int64_t within_q8;                /* largest distance of one over depth from its plane */
} t3r_planes;

/* Finds the planes with the most matched pixels, each without pixels on earlier ones. At most 2 T3R_PLANE_HYPOTHESES
 * T3R_PLANE_SAMPLES^2 comparisons. */
void t3r_search_planes(const t3r_view *view, void *work, t3r_planes *found);

#endif
