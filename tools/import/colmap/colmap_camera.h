/* SPDX-License-Identifier: Apache-2.0 */
/* Camera models of COLMAP. */
#ifndef TRIM3R_TOOLS_COLMAP_CAMERA_H
#define TRIM3R_TOOLS_COLMAP_CAMERA_H

#include <stdint.h>

#include "import/frames/posed_frame.h"

#define COLMAP_PARAMETERS_MOST 16u

typedef struct colmap_camera_model colmap_camera_model;

/* Returns NULL if there is no such model. */
const colmap_camera_model *colmap_model_of_id(int32_t id);
const colmap_camera_model *colmap_model_of_name(const char *name);
/* Returns the number of parameters, at most COLMAP_PARAMETERS_MOST. */
uint32_t colmap_model_parameters(const colmap_camera_model *model);

/* Makes the camera of a picture of width x height pixels. Returns NULL, or what is wrong: a lens without counterpart in
 * the runtime, by name, or a number that is not finite. */
const char *colmap_intrinsics(const colmap_camera_model *model, const double *parameters, uint64_t width,
                              uint64_t height, posed_intrinsics *out);

#endif
