/* What a stream notes beside each Gaussian: refinement reads it as well. */
#ifndef T3R_MAP_RECORD_H
#define T3R_MAP_RECORD_H

#include <stdint.h>

#define T3R_FITTED_MOST 4

/* Beside every Gaussian of the map, in its order. Any values are safe. */
typedef struct t3r_map_record {
    uint16_t key; /* of its pixel (budget/budget.h): the smaller, the longer it stays; at least T3R_MAP_KEY_LEAST */
    uint16_t faded_q10;  /* added to the key: grows while keyframes do not see it */
    int16_t wanted_q10;  /* log2 of the density that its texture asks for */
    int16_t density_q10; /* log2 of the share of its keyframe's pixels retained about it: it is as wide as that needs */
    int16_t grain_q8;    /* log2 of a pixel's width z / f on the surface, in its keyframe */
    uint8_t idle;        /* keyframes since one saw it about as finely as its own, at most 255 */
    uint8_t fitted;      /* keyframes behind its own that saw it so, at most T3R_FITTED_MOST */
} t3r_map_record;

#endif
