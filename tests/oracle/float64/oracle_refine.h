/* SPDX-License-Identifier: Apache-2.0 */
/* Refinement in float64, pass by pass, from the text of SPEC.md ("Refinement"). */
#ifndef TRIM3R_TESTS_ORACLE_REFINE_H
#define TRIM3R_TESTS_ORACLE_REFINE_H

#include "oracle_raster.h"

/* A context view: its picture, and the pixels that count. */
typedef struct oracle_context {
    oracle_camera camera;
    const uint8_t *rgb;    /* width x height x 3 */
    const uint8_t *counts; /* width x height, 0 = no depth */
} oracle_context;

/* The change of a Gaussian by a pass. */
typedef struct oracle_change {
    double colour[3]; /* levels */
    double step[6];   /* log opacity; shift along two axes; log scale, shear, log scale */
    double share;     /* share of the Gauss-Newton step; 0: no previous pass */
} oracle_change;

/* Runs a pass, which corrects the scene in place. changes[count]: the changes of the previous pass, 0 before the
 * first; on return the changes of this pass. */
void oracle_refine(oracle_gaussian *scene, size_t count, const oracle_context *views, size_t view_count,
                   oracle_change *changes);

#endif
