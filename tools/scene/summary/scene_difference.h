/* SPDX-License-Identifier: Apache-2.0 */
/* How far two scene files differ. */
#ifndef TRIM3R_TOOLS_SCENE_DIFFERENCE_H
#define TRIM3R_TOOLS_SCENE_DIFFERENCE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Gaussians of the same index are compared. They are equal if they are the same in the runtime's fixed point, and if
 * the numbers that it clamps (far positions, colours above 1, harmonics beyond 8) are the same in its steps, too. */
typedef struct scene_difference {
    uint32_t count[2];  /* Gaussians of either file */
    uint32_t degree[2]; /* of the harmonics */
    bool mip[2];        /* the file is marked for mip-splatting */
    uint32_t different; /* Gaussians that are not equal */
    uint32_t first;     /* the first of them */
    /* The largest differences, over those Gaussians */
    double position;   /* distance, world units */
    double covariance; /* of an entry, relative to the largest of either */
    double colour;     /* of degree 0, of 255 */
    double opacity;    /* of 1 */
    double harmonics;  /* of a coefficient above degree 0; a degree that one file lacks is 0 there */
} scene_difference;

/* Compares two files. flags: 0 or T3R_SCENE_DROP_INVALID. Returns 0, or -1 with the reason in error[]. */
int scene_difference_of(const char *const path[2], int flags, scene_difference *out, char *error, size_t error_bytes);
/* Whether there is no difference. */
bool scene_difference_none(const scene_difference *difference);

#endif
