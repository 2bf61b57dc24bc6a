/* Stage stereo: depth for two posed colour views (SPEC.md, "Stereo"). Rectification (rectify.h), a range of disparities
 * from a first look at a quarter of the size, matching (match.h), and back to the views' own pixels. */
#ifndef T3R_STEREO_H
#define T3R_STEREO_H

#include <stddef.h>
#include <stdint.h>

#include "core/workers.h"
#include "match.h"
#include "rectify.h"
#include "state/views.h"

/* Penalties of the aggregation: P1; P2 where luma does not change, and its least (DESIGN.md) */
#define T3R_STEREO_P1 20u
#define T3R_STEREO_P2 120u
#define T3R_STEREO_P2_MIN 30u
/* Match confidences of t3r_stereo_depth() */
#define T3R_STEREO_NONE 0u   /* no depth */
#define T3R_STEREO_FILLED 1u /* the surroundings' depth */
#define T3R_STEREO_LEAST 2u  /* 2..255: matched, the more, the surer */
#define T3R_STEREO_SURE 64u  /* from here on as good as measured: below, errors are two to four times as frequent */

typedef struct t3r_stereo_settings {
    const t3r_kernels *kernels;
    uint32_t disparities; /* most that are compared: 16..T3R_PATH_MOST, a multiple of 16 */
    uint32_t paths;       /* 4 or 8 */
    uint32_t fill;        /* 1 = holes get their surroundings' depth, T3R_STEREO_FILLED */
    t3r_workers workers;  /* which share rows; all 0: one after the other */
    uint32_t planes;      /* 1 = outlines that matched outlines are not trusted (plane_outline.h) */
} t3r_stereo_settings;

/* Depth and match confidence of two views of one size from their colours and checked, undistorted cameras. Both get
 * depths in steps of *depth_unit_q40 world units, 1..65535, 0 = none; match confidences T3R_STEREO_... On anything but
 * T3R_PAIR_OK planes and unit are undefined. */
t3r_pair t3r_stereo_depth(const t3r_stereo_settings *settings, const t3r_camera cameras[2], const t3r_view views[2],
                          void *work, uint64_t *depth_unit_q40);

/* The match score of a pair, to compare it with others of the same size: how many pixels a first look at a quarter of
 * the size trusts, each weighted by how well its distance would be known. A pair can still be refused later. *score is
 * set whatever is returned; same work. */
t3r_pair t3r_stereo_match_score(const t3r_stereo_settings *settings, const t3r_camera cameras[2],
                                const t3r_view views[2], void *work, uint32_t *score);

/* Turns the plane of match confidences into validity: T3R_MEASURED, below `least` (2..255) with T3R_MARK_DOUBTFUL;
 * T3R_FILLED where depth is the surroundings'; T3R_NO_DEPTH where there is none. */
void t3r_stereo_marks(const t3r_view *view, uint32_t least);

#endif
