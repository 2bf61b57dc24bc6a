/* SPDX-License-Identifier: Apache-2.0 */
/* Corners of a grey picture and what the picture shows around them, in integers: the same on every machine.
 *
 * A pyramid of pictures, each 4/5 of the one before; Harris corners in each, spread over the picture, their places by
 * a parabola to a fraction of a pixel; at each corner the direction of the patch's centroid and, turned by it, 256
 * comparisons of smoothed grey levels (ORB: Rublee and others, ICCV 2011; the pattern is our own). */
#ifndef TRIM3R_TOOLS_POSING_CORNERS_H
#define TRIM3R_TOOLS_POSING_CORNERS_H

#include <stdint.h>

#define CORNER_LEVELS 6u
#define CORNERS_MOST 1500u /* in a picture, all levels together */

typedef struct corner {
    int32_t x_q8, y_q8; /* pixels of the whole picture; (0, 0) is the centre of the top-left one */
    uint32_t level;     /* of the pyramid, 0 the picture itself: a pixel of it is (5/4)^level wide */
    uint64_t comparisons[4];
} corner;

/* Fills corners[], at most CORNERS_MOST, from a picture whose rows have no gaps; their number in *count. Pictures with
 * a side below 48 pixels have none. 0, or -1 when memory is out. */
int corners_find(const uint8_t *grey, uint32_t width, uint32_t height, corner *corners, uint32_t *count);

/* In how many of their comparisons two corners differ, 0..256. */
uint32_t corners_differ(const corner *a, const corner *b);

#endif
