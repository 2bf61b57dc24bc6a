/* One pass of refinement in float64, from the text of SPEC.md ("Refinement"). */
#ifndef TRIM3R_TESTS_ORACLE_REFINE_H
#define TRIM3R_TESTS_ORACLE_REFINE_H

#include "oracle_raster.h"

/* A context view: what it shows, and which pixels count. */
typedef struct oracle_context {
    oracle_camera camera;
    const uint8_t *rgb;    /* width x height x 3 */
    const uint8_t *counts; /* width x height, 0 = no depth */
} oracle_context;

/* The corrected Gaussians. */
void oracle_refine(const oracle_gaussian *scene, size_t count, const oracle_context *views, size_t view_count,
                   oracle_gaussian *refined);

#endif
