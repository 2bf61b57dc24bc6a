/* SPDX-License-Identifier: Apache-2.0 */
/* Folders with a sparse model of COLMAP. */
#ifndef TRIM3R_TOOLS_COLMAP_FOLDER_H
#define TRIM3R_TOOLS_COLMAP_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

#include "import/frames/posed_frame.h"

bool colmap_folder_is(const char *directory);

/* Reads the model's images that have a pose, in the order of their names, and depth: pictures if there are any and
 * options->depth_unit is given, else COLMAP's own dense maps. The scale is the model's. */
int colmap_folder_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                       size_t error_bytes);

#endif
