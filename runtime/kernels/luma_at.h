/* A picture's luma at places between its pixels (SPEC.md, "Stereo").
 *
 * Bilinear, as the undistortion has it: the place to Q8, round-half-up, held to the picture; one rounding of the four
 * pixels' weighted sum. */
#ifndef T3R_KERNEL_LUMA_AT_H
#define T3R_KERNEL_LUMA_AT_H

#include <stddef.h>

#include "ray_row.h"

typedef struct t3r_luma_picture {
    const uint8_t *luma;    /* 0 = nothing */
    uint32_t width, height; /* 2..8192 each */
} t3r_luma_picture;

/* out[i] = 1..255, and 0 where there is no place, where it is beyond the picture's pixels, and where the pixel nearest
 * to it has nothing. `count`: up to T3R_RAYS; those behind it, up to a multiple of 16, are read and mean nothing. */
typedef void t3r_luma_at_kernel(const t3r_luma_picture *picture, const t3r_ray_places *places, uint32_t count,
                                uint8_t *out);
t3r_luma_at_kernel t3r_luma_at_c;

#endif
