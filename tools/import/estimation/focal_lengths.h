/* SPDX-License-Identifier: Apache-2.0 */
/* Focal lengths of pictures whose folder does not give them. */
#ifndef TRIM3R_TOOLS_IMPORT_FOCAL_LENGTHS_H
#define TRIM3R_TOOLS_IMPORT_FOCAL_LENGTHS_H

#include <stdbool.h>

#include "import/frames/posed_frame.h"

/* Whether nothing says the focal length of a frame. */
bool focal_length_is_unknown(const posed_frame *frame);

/* Takes the focal length of each frame without one from the picture's EXIF; where some pictures state none, from the
 * first that does, in proportion to the longer side. Says so in folder->focal. Pictures that cannot be read stay as
 * they are. */
void focal_lengths_from_exif(const char *directory, posed_folder *folder);

/* Sets a share of the longer side as the focal length of each frame without one. */
void focal_lengths_set(const char *directory, posed_folder *folder, double share);

#endif
