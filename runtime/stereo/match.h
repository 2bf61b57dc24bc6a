/* Stage stereo, second part: disparities of a rectified pair by semi-global matching (SPEC.md, "Stereo").
 *
 * Pixel (x, y) of the left plane is sought at (x + disparities - 1 - k, y) of the right one, k = 0..disparities - 1:
 * the right plane is disparities - 1 columns wider, so that every pixel has all its candidates.
 *
 * Aggregated costs are kept for T3R_MATCH_ROWS(height) rows at a time. Paths downwards run twice: once over the whole
 * picture, leaving their state at the beginning of every such block of rows, and once more block by block from the last
 * to the first, each followed by the paths upwards. So work grows with width x disparities x sqrt(height). */
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
    uint32_t p1, p2, p2_min; /* penalties: P1; P2 where luma does not change, and its least */
    bool distrust_outlines;  /* those that match each other (plane_outline.h) */
    const uint8_t *luma[2];  /* left, right: 1..255, 0 = no luma */
    uint16_t *disparity[2];  /* as kernels/disparity_at.h has it; of the left plane's width, of the right one's */
    uint8_t *confidence[2];  /* how much better the chosen disparity is than any other: 1..255, 0 = not to be trusted */
    void *work;
} t3r_match;

/* Both planes' disparities and confidences, clean, and filled where wanted: t3r_match_pair(), then those of
 * match_clean.h. Without filling disparities of confidence 0 mean nothing. */
void t3r_match_all(const t3r_match *match, bool fill);

/* Each pixel's best disparity, whether the other picture agrees or not; confidence of the left plane alone. */
void t3r_match_pair(const t3r_match *match);

#endif
