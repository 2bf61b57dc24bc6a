/* SPDX-License-Identifier: Apache-2.0 */
/* Stage stereo: depth for two posed colour views (SPEC.md, "Stereo"). It rectifies (rectify.h), finds the range of
 * disparities in a coarse pass at a quarter of the size, matches (match.h), and returns to the views' own pixels. */
#ifndef T3R_STEREO_H
#define T3R_STEREO_H

#include <stddef.h>
#include <stdint.h>

#include "core/workers.h"
#include "match.h"
#include "rectify.h"
#include "state/views.h"

/* Penalties of the aggregation (DESIGN.md): P1, P2 where luma doesn't change, and the least P2. */
#define T3R_STEREO_P1 20u
#define T3R_STEREO_P2 120u
#define T3R_STEREO_P2_MIN 30u
/* Match confidences of t3r_stereo_depth(). */
#define T3R_STEREO_NONE 0u   /* no depth */
#define T3R_STEREO_FILLED 1u /* depth of the surroundings */
#define T3R_STEREO_LEAST 2u  /* 2..255: matched, larger is surer */
#define T3R_STEREO_SURE                                                                                                \
    64u /* from here on reliable like a measurement; below, errors are two to four times as frequent */

typedef struct t3r_stereo_settings {
    const t3r_kernels *kernels;
    uint32_t disparities; /* maximum number compared: 16..T3R_PATH_MOST, a multiple of 16 */
    uint32_t paths;       /* 4 or 8 */
    uint32_t fill;        /* 1 = holes get the depth of their surroundings, T3R_STEREO_FILLED */
    t3r_workers workers;  /* share rows; all 0: one row after the other */
} t3r_stereo_settings;

/* Computes depth and match confidence of two views of one size from their colours and checked, undistorted cameras.
 * Depths are steps of *depth_unit_q40 world units, 1..65535, 0 = none; match confidences are T3R_STEREO_... Unless
 * T3R_PAIR_OK is returned, planes and unit are undefined. */
t3r_pair t3r_stereo_depth(const t3r_stereo_settings *settings, const t3r_camera cameras[2], const t3r_view views[2],
                          void *work, uint64_t *depth_unit_q40);

/* Computes the match score of a pair, to compare it with other pairs of the same size: the number of pixels that a
 * coarse pass at a quarter of the size trusts, each weighted by how well its distance is known. The pair can still be
 * refused later. *score is always set. work: as in t3r_stereo_depth(). */
t3r_pair t3r_stereo_match_score(const t3r_stereo_settings *settings, const t3r_camera cameras[2],
                                const t3r_view views[2], void *work, uint32_t *score);

/* Converts the plane of match confidences into validity: T3R_MEASURED, with T3R_MARK_DOUBTFUL below `least` (2..255);
 * T3R_FILLED for filled depth; T3R_NO_DEPTH without depth. */
void t3r_stereo_marks(const t3r_view *view, uint32_t least);

#endif
