/* SPDX-License-Identifier: Apache-2.0 */
/* The Gaussian head turns retained points into Gaussians that also cover the pruned points around them. Every head
 * predicts a footprint in the image plane, in pixels of the source view; t3r_lift() makes it a 3-D Gaussian on the
 * surface. */
#ifndef T3R_HEAD_H
#define T3R_HEAD_H

#include <stdbool.h>
#include <stdint.h>

#include "budget/budget.h"
#include "kernels/kernels.h"
#include "pointmap/pointmap.h"
#include "superclusters/superclusters.h"

#define T3R_HEAD_OPACITY_Q15 31457 /* 0.96, for heads that do not predict an opacity */

/* The views that may cover a surface together. */
typedef struct t3r_covering_views {
    const t3r_view *views;
    uint32_t count;
    int32_t exponent;         /* of the scene's frame */
    int32_t mean_density_q10; /* log2 of the retained share of the points */
} t3r_covering_views;

/* A head's input from one view. */
typedef struct t3r_head_input {
    const t3r_kernels *kernels;
    t3r_pointmap map;
    uint32_t view_index;
    const t3r_budget_settings *settings;
    const t3r_cluster *clusters;
    const void *weights; /* of `learned`, checked; NULL for the others */
    void *work;          /* of `learned`: at least t3r_head_learned_work_bytes() */
    size_t work_bytes;
    const t3r_covering_views *covering; /* other views for fitted widths; NULL: only the own view */
    uint32_t narrowest_q12;             /* T3R_NARROWEST... of this build */
    bool unadapted;                     /* the head takes every point as retained, with spacing 1 */
    bool (*goes_on)(void *context);     /* called before each row, false cancels; NULL: never cancelled */
    void *context;                      /* for goes_on */
} t3r_head_input;

/* A total footprint in the image plane of the source view: mean and covariance in pixels. */
typedef struct t3r_footprint {
    int32_t offset_q12[2];
    int32_t xx_q12, xy_q12, yy_q12; /* covariance, px^2 */
    uint16_t colour_q7[3];
    uint16_t opacity_q15;
} t3r_footprint;

/* The least variance of a Gaussian in its own view, without the 0.3 px^2 that the rasterizer adds; Q12. A Gaussian
 * that refinement corrects by one view's pixels must not be much narrower, because other views look between these
 * pixels (Yu et al., Mip-Splatting, 2024, section 5.1, who smooth by as much; DESIGN.md, "Heads"). An uncorrected one
 * stays as sharp as the head made it. */
#define T3R_NARROWEST_Q12 82          /* 0.02 px^2 */
#define T3R_NARROWEST_REFINED_Q12 819 /* 0.2 px^2 */

/* Converts a footprint at pixel (u, v) to a Gaussian: covariance [tu tv] (S - 0.3 I) [tu tv]^T and a thin normal term.
 * The rasterizer adds the 0.3 px^2 back. The pixel must have a depth. */
void t3r_lift(const t3r_head_input *input, uint32_t u, uint32_t v, const t3r_footprint *footprint,
              t3r_gaussian *gaussian);

/* Writes a factor, whose entries have `fraction` fraction bits and are below 2^62, as mantissas with a shared
 * exponent: the largest gets 14 bits. */
void t3r_pack_factor(const int64_t entry[9], int32_t fraction, t3r_gaussian *gaussian);

/* Returns the distance of kept neighbours about a retained pixel: pixels, Q12, at least 1; 1 when unadapted. */
uint32_t t3r_spacing_q12(const t3r_head_input *input, size_t pixel);

static inline bool t3r_head_goes_on(const t3r_head_input *input)
{
    return input->goes_on == NULL || input->goes_on(input->context);
}

#define T3R_HEAD_STOPPED UINT32_MAX

/* A head: writes the Gaussians of the retained points in the rows begin..end - 1, in raster order, to `out` and
 * returns their number, or T3R_HEAD_STOPPED. The bands of a view together give the same Gaussians as the whole view. */
typedef uint32_t t3r_head_rows(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out);

/* X(enumerator of t3r_head, name, function), one row per head. */
#define T3R_HEADS(X)                                                                                                   \
    X(T3R_HEAD_ANALYTIC, "analytic", t3r_head_analytic)                                                                \
    X(T3R_HEAD_LEARNED, "learned", t3r_head_learned)

#define T3R_HEAD_FUNCTION_(HEAD, name, function) t3r_head_rows function;
T3R_HEADS(T3R_HEAD_FUNCTION_)

/* Returns the work bytes that a learned head needs for views of this width. */
size_t t3r_head_learned_work_bytes(const void *weights, uint32_t width);
/* Returns the work bytes with room for packed layers, which are faster; SIZE_MAX if they cannot be packed. This is for
 * planning: a head packs its layers whenever they fit. */
size_t t3r_head_learned_packed_bytes(const void *weights, uint32_t width);

#endif
