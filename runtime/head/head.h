/* SPDX-License-Identifier: Apache-2.0 */
/* The Gaussian head: retained points to Gaussians that also cover what was pruned around them. Every head predicts a
 * footprint in the image plane, in pixels of the source view; t3r_lift() makes it a 3-D Gaussian on the surface. */
#ifndef T3R_HEAD_H
#define T3R_HEAD_H

#include <stdbool.h>
#include <stdint.h>

#include "budget/budget.h"
#include "kernels/kernels.h"
#include "pointmap/pointmap.h"
#include "superclusters/superclusters.h"

#define T3R_HEAD_OPACITY_Q15 31457 /* 0.96, of heads that do not predict one */

/* The views that may cover a surface together. */
typedef struct t3r_covering_views {
    const t3r_view *views;
    uint32_t count;
    int32_t exponent;         /* of the scene's frame */
    int32_t mean_density_q10; /* log2 of the share of the points that is retained */
} t3r_covering_views;

/* What a head sees of one view. */
typedef struct t3r_head_input {
    const t3r_kernels *kernels;
    t3r_pointmap map;
    uint32_t view_index;
    const t3r_budget_settings *settings;
    const t3r_cluster *clusters;
    const void *weights; /* of `learned`, checked; NULL for the others */
    void *work;          /* of `learned`: at least t3r_head_learned_work_bytes() */
    size_t work_bytes;
    const t3r_covering_views *covering; /* what widths are fitted to; NULL: the own view alone */
    uint32_t narrowest_q12;             /* T3R_NARROWEST..., of this build */
    bool unadapted;                     /* the head takes every point for retained, spacing 1 */
    bool (*goes_on)(void *context);     /* asked before each row; NULL: the head is not to be stopped */
    void *context;                      /* of goes_on */
} t3r_head_input;

/* A total footprint in the image plane: mean and covariance in pixels, as the source view shall show it. */
typedef struct t3r_footprint {
    int32_t offset_q12[2];
    int32_t xx_q12, xy_q12, yy_q12; /* covariance, px^2 */
    uint16_t colour_q7[3];
    uint16_t opacity_q15;
} t3r_footprint;

/* The least variance of a Gaussian in its own view, less the 0.3 px^2 that the rasterizer adds; Q12. What is corrected
 * by what one view's pixels show must not be much narrower than these: other views look between them (Yu et al.,
 * Mip-Splatting, 2024, section 5.1, who smooth by as much; DESIGN.md, "Heads"). What nothing corrects stays as sharp
 * as the head has it. */
#define T3R_NARROWEST_Q12 82          /* 0.02 px^2 */
#define T3R_NARROWEST_REFINED_Q12 819 /* 0.2 px^2 */

/* A footprint at pixel (u, v) to a Gaussian: covariance [tu tv] (S - 0.3 I) [tu tv]^T and a thin normal term. The
 * rasterizer adds the 0.3 px^2 back. The pixel must have a depth. */
void t3r_lift(const t3r_head_input *input, uint32_t u, uint32_t v, const t3r_footprint *footprint,
              t3r_gaussian *gaussian);

/* Writes a factor, entries of `fraction` fraction bits below 2^62, as mantissas with a shared exponent: the largest
 * gets 14 bits. */
void t3r_pack_factor(const int64_t entry[9], int32_t fraction, t3r_gaussian *gaussian);

/* Kept neighbours are this far apart about a retained pixel: pixels, Q12, at least 1; 1 when unadapted. */
uint32_t t3r_spacing_q12(const t3r_head_input *input, size_t pixel);

static inline bool t3r_head_goes_on(const t3r_head_input *input)
{
    return input->goes_on == NULL || input->goes_on(input->context);
}

#define T3R_HEAD_STOPPED UINT32_MAX

/* Each writes the Gaussians of the retained points in the rows begin..end - 1, in raster order, to `out` and returns
 * their number, or T3R_HEAD_STOPPED. The bands of a view together give what the whole view gives. */
typedef uint32_t t3r_head_rows(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out);

/* X(enumerator of t3r_head, name, function), a row a head. */
#define T3R_HEADS(X)                                                                                                   \
    X(T3R_HEAD_ANALYTIC, "analytic", t3r_head_analytic)                                                                \
    X(T3R_HEAD_LEARNED, "learned", t3r_head_learned)

#define T3R_HEAD_FUNCTION_(HEAD, name, function) t3r_head_rows function;
T3R_HEADS(T3R_HEAD_FUNCTION_)

/* Bytes of work that a learned head needs for views of this width. */
size_t t3r_head_learned_work_bytes(const void *weights, uint32_t width);
/* The same with room for packed layers, which are faster; SIZE_MAX where they cannot be packed. */
size_t t3r_head_learned_packed_bytes(const void *weights, uint32_t width);

#endif
