/* SPDX-License-Identifier: Apache-2.0 */
/* Disparities of a plane at places between its pixels, and the places they lead to (SPEC.md, "Stereo"). */
#ifndef T3R_KERNEL_DISPARITY_AT_H
#define T3R_KERNEL_DISPARITY_AT_H

#include <stdbool.h>
#include <stddef.h>

#include "core/divisor.h"
#include "ray_row.h"

#define T3R_NO_DISPARITY UINT16_MAX
#define T3R_DISPARITY_BITS 7 /* disparities k are in Q7 */

typedef struct t3r_disparity_plane {
    const uint16_t *disparity; /* k in Q7, below 2^15, or T3R_NO_DISPARITY */
    const uint8_t *confidence;
    uint32_t width, height; /* 2..8192 each */
    int32_t begin_q16;      /* start of its columns */
    int32_t first;          /* disparity of k = 0, pixels: |first| below 2^14 */
    bool right;  /* the plane is the second view's: matches are to the right in the other plane, else to the left */
    bool filled; /* disparities of confidence 0 count */
    t3r_divisor scale; /* pixels a unit of column, Q16: 2^16 up to 2^29 */
} t3r_disparity_plane;

typedef struct t3r_disparities {
    int32_t disparity_q16[T3R_RAYS],
        confidence[T3R_RAYS];                       /* 0: none, and all outputs are 0; 1: filled; 2..255: matched */
    int32_t own_q24[T3R_RAYS], other_q24[T3R_RAYS]; /* units of column: of the place, and of its match */
} t3r_disparities;

/* Looks up disparities. The disparity at a place is the nearest pixel's. It is interpolated between the four pixels
 * around the place if either all or none of them are matched, and all are within a pixel of the nearest one's. Columns
 * count from the baseline's normal, rows from the plane's first; a place has z. `count`: up to T3R_RAYS; entries after
 * it, up to a multiple of 16, are read and written with any values. */
typedef void t3r_disparity_at_kernel(const t3r_disparity_plane *plane, const t3r_ray_places *places, uint32_t count,
                                     t3r_disparities *out);
t3r_disparity_at_kernel t3r_disparity_at_c;

#endif
