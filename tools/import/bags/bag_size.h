/* SPDX-License-Identifier: Apache-2.0 */
/* Frames of a bag in another size, as folders' frames are (crop.h). */
#ifndef TRIM3R_TOOLS_BAG_SIZE_H
#define TRIM3R_TOOLS_BAG_SIZE_H

#include <stddef.h>
#include <stdint.h>

#include "pictures/picture.h"
#include "trim3r_capture.h"
#include "trim3r_host.h"

typedef struct bag_size {
    uint32_t width, height; /* 0: as the frames are */
    picture colour, depth;  /* the last frame's */
} bag_size;

/* Keeps the part of a frame's colour; its edges are even where colours share pixels. */
void bag_size_crop(const t3r_crop *part, t3r_frame *frame);
/* Adapts intrinsics to the part. */
void bag_size_crop_camera(const t3r_crop *part, t3r_camera *camera);

/* Converts colour of any format, with sides up to PICTURE_LARGEST_SIDE, to RGB. Returns NULL, or what is wrong. */
const char *bag_size_colour(const t3r_frame *frame, picture *out);

/* Crops and resizes colour and depth, which show the same view, and adapts the camera. The frame stays valid until the
 * next call. Returns 0, or -1 with a reason; call bag_size_free() in the end. */
int bag_size_apply(bag_size *size, t3r_capture_frame *frame, char *error, size_t error_bytes);
void bag_size_free(bag_size *size);

#endif
