/* Folders with a text file for each pose, as exports of ScanNet have them. */
#ifndef TRIM3R_TOOLS_POSE_FILES_H
#define TRIM3R_TOOLS_POSE_FILES_H

#include <stdbool.h>
#include <stddef.h>

#include "import/folders/posed_frame.h"

bool pose_files_are_there(const char *directory);

/* Each file of `pose` with the picture and the depth of its name. A pose that is not finite is one that was lost: its
 * picture is left out, or stays without a pose where options->without_poses. */
int pose_files_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                    size_t error_bytes);

#endif
