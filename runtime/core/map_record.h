/* SPDX-License-Identifier: Apache-2.0 */
/* A stream's record of each Gaussian, which refinement reads as well. */
#ifndef T3R_MAP_RECORD_H
#define T3R_MAP_RECORD_H

#include <stdint.h>

#define T3R_FITTED_MOST 15
#define T3R_EARLIER_PIECE 255 /* instead of `fitted`: of an earlier piece of the map, not seen since */

/* One record for each Gaussian of the map, in the map's order. Any values are safe. */
typedef struct t3r_map_record {
    uint16_t key;        /* of its pixel (budget/budget.h): smaller keys stay longer; at least T3R_MAP_KEY_LEAST */
    uint16_t faded_q10;  /* added to the key; grows while no keyframe sees the Gaussian */
    int16_t wanted_q10;  /* log2 of the density that its texture asks for */
    int16_t density_q10; /* log2 of the share of its keyframe's pixels retained around it, which its width matches */
    int16_t grain_q8;    /* log2 of a pixel's width z / f on the surface, in its keyframe */
    uint8_t idle;        /* keyframes since the last one that saw it about as finely as its own, at most 255 */
    uint8_t fitted;      /* keyframes after its own that saw it about as finely, at most T3R_FITTED_MOST */
} t3r_map_record;

#endif
