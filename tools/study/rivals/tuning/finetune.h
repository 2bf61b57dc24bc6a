/* SPDX-License-Identifier: Apache-2.0 */
/* Per-scene fine-tuning: Adam on all parameters of a fixed number of Gaussians; the context views are the only
 * examples.
 *
 * Follows the training of 3D Gaussian Splatting (Kerbl et al. 2023, section 5), without densification and with all
 * context views in every iteration. */
#ifndef TRIM3R_TOOLS_RIVALS_FINETUNE_H
#define TRIM3R_TOOLS_RIVALS_FINETUNE_H

#include <stdbool.h>
#include <stdint.h>

#include "study/rivals/splats/splat_view.h"
#include "trim3r_host.h"

/* The target picture of a view. */
typedef struct finetune_target {
    splat_camera camera;
    const uint8_t *rgb; /* width x height x 3 */
} finetune_target;

/* Step sizes of Adam, per kind of parameter. */
typedef struct finetune_rates {
    double position; /* scene units: the median depth is between one and two */
    double log_scale, rotation, logit, colour;
} finetune_rates;

/* Tuned on training scenes from the start of neighbour_widen() (docs/rivals.md), the same in every iteration. */
extern const finetune_rates finetune_rates_default;
/* The rates with which 3D Gaussian Splatting and the rivals' programs train for thousands of iterations. */
extern const finetune_rates finetune_rates_published;

/* Changes the model in place, with the same result for any number of threads (NULL: the caller's alone). False if out
 * of memory; the model is then the result of the last complete iteration. */
bool finetune(splat_model *model, const finetune_target *targets, uint32_t target_count, uint32_t iterations,
              const finetune_rates *rates, t3r_threads *threads);

#endif
