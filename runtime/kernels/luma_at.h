/* SPDX-License-Identifier: Apache-2.0 */
/* A picture's luma at places between its pixels (SPEC.md, "Stereo").
 *
 * Bilinear as in undistortion: the place is rounded to Q8, half up, and clamped to the picture, and the weighted sum of
 * the four pixels is rounded once. */
#ifndef T3R_KERNEL_LUMA_AT_H
#define T3R_KERNEL_LUMA_AT_H

#include <stddef.h>

#include "ray_row.h"

typedef struct t3r_luma_picture {
    const uint8_t *luma;    /* 0 = no luma */
    uint32_t width, height; /* 2..8192 each */
} t3r_luma_picture;

/* Computes out[i] = 1..255, or 0 without a place, for a place outside the picture, and if its nearest pixel has no
 * luma. `count`: up to T3R_RAYS; places after it, up to a multiple of 16, are read and ignored. */
typedef void t3r_luma_at_kernel(const t3r_luma_picture *picture, const t3r_ray_places *places, uint32_t count,
                                uint8_t *out);
t3r_luma_at_kernel t3r_luma_at_c;

#endif
