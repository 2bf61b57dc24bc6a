/* SPDX-License-Identifier: Apache-2.0 */
/* Decodes the compressed images of a bag for import, and converts encodings that the runtime does not read. */
#ifndef TRIM3R_TOOLS_BAG_PICTURES_H
#define TRIM3R_TOOLS_BAG_PICTURES_H

#include "pictures/picture.h"
#include "recording/recording.h"

typedef struct bag_pictures {
    picture colour, depth; /* the last ones decoded */
} bag_pictures;

/* Returns a decoder of JPEG, PNG and the PNG of compressedDepth (16UC1 unchanged, 32FC1 by the scale in the message);
 * rgba8, bgra8, 8UC4 and bayer become RGB.
 * `pictures` is initialised with zeros and outlives the recording; call bag_pictures_free() when the recording is
 * closed. */
t3r_image_decoder bag_pictures_decoder(bag_pictures *pictures);
void bag_pictures_free(bag_pictures *pictures);

#endif
