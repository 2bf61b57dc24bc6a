/* The step of semi-global aggregation: one pixel along its paths (SPEC.md, "Stereo").
 *
 *     L(p, k) = C(p, k) + min(L'(k), L'(k - 1) + P1, L'(k + 1) + P1, P2),    L' = L(before p on the path) - its least
 *
 * C is at most 24, so L at most 24 + P2 and the least of L at most 24: with P1 + P2 + 24 < 256 nothing leaves 8 bits.
 */
#ifndef T3R_KERNEL_PATH_STEP_H
#define T3R_KERNEL_PATH_STEP_H

#include <stdbool.h>
#include <stdint.h>

#define T3R_PATH_LANES 16u
#define T3R_PATH_MOST 256u /* disparities */
#define T3R_PATH_LINKS 4   /* most paths through a pixel */

/* A pixel on one path. */
typedef struct t3r_path_link {
    const uint8_t *from; /* the pixel before: a guard byte, the values of all disparities, a guard byte */
    uint8_t *to;         /* this pixel's values */
    uint8_t from_least;  /* the least of the pixel before */
    uint8_t p2;          /* P2 between the two pixels */
    uint8_t least;       /* set to the least of this pixel's values */
} t3r_path_link;

/* One pixel of `count` disparities, a multiple of 16 up to T3R_PATH_MOST, along `paths` links, 1..4. A link's `to` is
 * no place that any link or `cost` reads. sums, of 2 or 4 paths: set to the sum of their values a disparity, or, with
 * `add`, that is added; NULL: not wanted. Nothing is aligned, but sums to 2 bytes; guards are read and not written. */
typedef void t3r_path_step_kernel(const uint8_t *cost, t3r_path_link *links, uint32_t paths, uint8_t p1, uint32_t count,
                                  bool add, int16_t *sums);
t3r_path_step_kernel t3r_path_step_c;

#endif
