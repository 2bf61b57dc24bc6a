/* SPDX-License-Identifier: Apache-2.0 */
/* Leaves out the border of one colour that all images of a bag have (picture_border.h). */
#ifndef TRIM3R_TOOLS_BAG_BORDER_H
#define TRIM3R_TOOLS_BAG_BORDER_H

#include <stddef.h>

#include "pictures/picture_border.h"
#include "recording/recording.h"

/* Finds what lies inside the border of a recording's colour images; width 0: there is no border. Frames that cannot be
 * read do not count. Sides of a border are even where colours share pixels. Returns NULL, or what is wrong. */
const char *bag_border_find(const t3r_recording *recording, picture_inner *inner);

/* Crops colour and depth, which show the same view, and adapts the camera. Nothing is copied. Returns 0, or -1 with a
 * reason if the image has not the size that the border was found in. */
int bag_border_cut(const picture_inner *inner, t3r_capture_frame *frame, char *error, size_t error_bytes);

#endif
