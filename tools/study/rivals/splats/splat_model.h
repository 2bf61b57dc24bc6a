/* SPDX-License-Identifier: Apache-2.0 */
/* Gaussians as free parameters in double for an optimiser, converted from and to the scene's integers.
 *
 * The parameters are those of 3D Gaussian Splatting (Kerbl et al. 2023, section 5): logarithms of the scales, a
 * quaternion of any norm, the logit of the opacity. */
#ifndef TRIM3R_TOOLS_RIVALS_SPLAT_MODEL_H
#define TRIM3R_TOOLS_RIVALS_SPLAT_MODEL_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

/* Offsets of a Gaussian's parameters in its row. */
enum {
    SPLAT_POSITION = 0,  /* 3: scene units */
    SPLAT_LOG_SCALE = 3, /* 3: natural logarithm of the standard deviations in scene units */
    SPLAT_ROTATION = 6,  /* 4: quaternion w x y z, axes to scene, any norm above 0 */
    SPLAT_LOGIT = 10,    /* opacity = 1 / (1 + exp(-logit)) */
    SPLAT_COLOUR = 11,   /* 3: r g b, 0..1 */
    SPLAT_PARAMETERS = 14
};

typedef struct splat_model {
    uint32_t count;
    uint32_t surfaces;  /* the first so many are of surfaces; rim and backdrop follow */
    double *parameters; /* count rows of SPLAT_PARAMETERS */
} splat_model;

/* Returns false if out of memory; call splat_model_free() in any case. */
bool splat_model_of(splat_model *model, const t3r_gaussian *gaussians, uint32_t count);
void splat_model_free(splat_model *model);

/* Stores the nearest representable Gaussian. View and confidence keep their values; so does the shape if the new one
 * is not representable. */
void splat_model_store(const double parameters[SPLAT_PARAMETERS], t3r_gaussian *gaussian);

#endif
