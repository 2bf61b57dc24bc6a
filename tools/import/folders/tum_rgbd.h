/* SPDX-License-Identifier: Apache-2.0 */
/* TUM RGB-D lists. */
#ifndef TRIM3R_TOOLS_TUM_RGBD_H
#define TRIM3R_TOOLS_TUM_RGBD_H

#include <stddef.h>

#include "import/frames/posed_frame.h"

/* Reads the three lists of a TUM RGB-D folder. */
int tum_rgbd_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                  size_t error_bytes);

#endif
