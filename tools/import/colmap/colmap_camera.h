/* Camera models of COLMAP. */
#ifndef TRIM3R_TOOLS_COLMAP_CAMERA_H
#define TRIM3R_TOOLS_COLMAP_CAMERA_H

#include <stdint.h>

#include "import/folders/posed_frame.h"

#define COLMAP_PARAMETERS_MOST 16u

typedef struct colmap_camera_model colmap_camera_model;

/* NULL: there is no such model. */
const colmap_camera_model *colmap_model_of_id(int32_t id);
const colmap_camera_model *colmap_model_of_name(const char *name);
/* How many numbers it has, COLMAP_PARAMETERS_MOST or fewer. */
uint32_t colmap_model_parameters(const colmap_camera_model *model);

/* The camera of a picture of width x height pixels. NULL, or what is wrong: a lens that has no counterpart in the
 * runtime, which is named, or a number that is not finite. */
const char *colmap_intrinsics(const colmap_camera_model *model, const double *parameters, uint64_t width,
                              uint64_t height, posed_intrinsics *out);

#endif
