/* SPDX-License-Identifier: Apache-2.0 */
/* Stage stereo, second part: disparities of a rectified pair by semi-global matching (SPEC.md, "Stereo").
 *
 * Pixel (x, y) of the left plane is compared with (x + disparities - 1 - k, y) of the right one, k = 0..disparities
 * - 1. The right plane is disparities - 1 columns wider, so every pixel has all its candidates.
 *
 * Aggregated costs are kept for T3R_MATCH_ROWS(height) rows at a time. Downward paths run twice: first over the whole
 * picture, storing their state at the start of every such block of rows, then again block by block from the last to the
 * first, each followed by the upward paths. So memory grows with width x disparities x sqrt(height). */
#ifndef T3R_MATCH_H
#define T3R_MATCH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "path.h"
#include "trim3r_arena.h"

typedef struct t3r_match {
    const t3r_kernels *kernels;
    uint32_t width, height;  /* of the left plane; at least 8 x 8 */
    uint32_t disparities;    /* 16..T3R_PATH_MOST, a multiple of 16 */
    uint32_t paths;          /* 4 or 8 */
    uint32_t p1, p2, p2_min; /* penalties: P1; P2 where luma doesn't change; least P2 */
    const uint8_t *luma[2];  /* left, right: 1..255, 0 = no luma */
    uint16_t *disparity[2];  /* as in kernels/disparity_at.h; of the left and the right plane's width */
    uint8_t *confidence[2];  /* margin of the chosen disparity over all others: 1..255, 0 = not trusted */
    void *work;
} t3r_match;

/* Computes disparities and confidences of both planes, cleaned and, with `fill`, filled: t3r_match_pair(), then the
 * steps of match_clean.h. Without `fill`, disparities of confidence 0 are undefined. */
void t3r_match_all(const t3r_match *match, bool fill);

/* Computes each pixel's best disparity, without a check against the other picture, and the confidence of the left
 * plane. */
void t3r_match_pair(const t3r_match *match);

#endif
