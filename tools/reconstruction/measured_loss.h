/* SPDX-License-Identifier: Apache-2.0 */
/* Builds the fewest Gaussians that lose little in new views, as measured halfway between the context views. */
#ifndef TRIM3R_TOOLS_MEASURED_LOSS_H
#define TRIM3R_TOOLS_MEASURED_LOSS_H

#include <stdint.h>

#include "trim3r.h"

typedef struct measured_loss {
    uint32_t builds; /* scenes that were built; 0 = nothing to compare, so the loss is only predicted */
    double loss;     /* dB, of the scene against one of all points */
} measured_loss;

/* Returns the percentage of the new views of the training scenes that stayed within the bound. */
int measured_loss_held(const measured_loss *loss, double max_loss);

/* Builds the fewest Gaussians, at most request->gaussians, whose measured loss is at most max_loss dB, or
 * request->gaussians if no number of them is enough. The runtime has analysed `views` views and kept the analysis; its
 * configuration allows a scene of all valid points. If the views share no surface, the runtime predicts the number.
 * On an error `reason` gets its text, T3R_ERROR_BYTES. */
t3r_status measured_loss_build(t3r_runtime *runtime, const t3r_config *config, const t3r_request *request,
                               double max_loss, t3r_scene *scene, measured_loss *found, char *reason);

#endif
