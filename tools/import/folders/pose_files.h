/* SPDX-License-Identifier: Apache-2.0 */
/* Folders with a text file for each pose, as in exports of ScanNet. */
#ifndef TRIM3R_TOOLS_POSE_FILES_H
#define TRIM3R_TOOLS_POSE_FILES_H

#include <stdbool.h>
#include <stddef.h>

#include "import/frames/posed_frame.h"

bool pose_files_are_there(const char *directory);

/* Reads each file of `pose`, with the picture and the depth of the same name. A pose that is not finite marks lost
 * tracking: its picture is left out, or stays without a pose if options->without_poses. */
int pose_files_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                    size_t error_bytes);

#endif
