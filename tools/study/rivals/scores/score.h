/* SPDX-License-Identifier: Apache-2.0 */
/* Scores of Gaussians by published methods, from a scene and the context views that it was made of. One file per
 * method, each from its paper's definition; none reads the pictures, only what the scene draws.
 *
 * `views` are open and projected with `model`. score[model->count]: higher ones are kept first; never NaN. False if out
 * of memory. */
#ifndef TRIM3R_TOOLS_RIVALS_SCORE_H
#define TRIM3R_TOOLS_RIVALS_SCORE_H

#include <stdbool.h>
#include <stdint.h>

#include "study/rivals/scores/kinds.h"
#include "study/rivals/splats/splat_view.h"

/* LightGaussian's exponent of the volume, from its authors' code. */
#define LIGHTGAUSSIAN_BETA 0.1
/* Number of dominant Gaussians per pixel in EfficientGS, from its authors' code. */
#define EFFICIENTGS_MOST 1u

/* Computes the score of the rival `kind`; METHOD_TRIM3R, which ranks no Gaussians, gets score_random(). Only random
 * uses the seed. */
bool score_of(method_kind kind, const splat_model *model, const splat_view *views, uint32_t view_count, uint32_t seed,
              double *score);

bool score_random(const splat_model *model, uint32_t seed, double *score);
bool score_eagles(const splat_model *model, const splat_view *views, uint32_t view_count, double *score);
bool score_lightgaussian(const splat_model *model, const splat_view *views, uint32_t view_count, double *score);
bool score_pup(const splat_model *model, const splat_view *views, uint32_t view_count, double *score);
bool score_efficientgs(const splat_model *model, const splat_view *views, uint32_t view_count, double *score);

/* Returns the logarithm of the determinant of a symmetric, positive semi-definite 6 x 6 matrix in double. Pivots (of
 * the matrix scaled to a unit diagonal) are held above 2^-24, the precision of the float sums that it came from;
 * -HUGE_VAL if a diagonal entry is 0. */
double score_pup_log_determinant(double matrix[6][6]);

#endif
