/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures that a data set ships in smaller sizes: images_2, images_4, images_8 beside or instead of images. */
#ifndef TRIM3R_TOOLS_REDUCED_PICTURES_H
#define TRIM3R_TOOLS_REDUCED_PICTURES_H

#include "import/frames/posed_frame.h"

/* If the folder that the frames name their pictures in is absent, takes the largest of its reduced ones, with
 * intrinsics scaled to it, and says so. Frames that do not say what size their intrinsics are for are rejected. */
void reduced_pictures_take(const char *directory, posed_folder *folder);

#endif
