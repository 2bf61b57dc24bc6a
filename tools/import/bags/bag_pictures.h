/* SPDX-License-Identifier: Apache-2.0 */
/* Decodes the compressed images of a bag for import, and converts encodings that the runtime does not read. */
#ifndef TRIM3R_TOOLS_BAG_PICTURES_H
#define TRIM3R_TOOLS_BAG_PICTURES_H

#include <stdbool.h>

#include "pictures/picture.h"
#include "recording/recording.h"

typedef struct bag_pictures {
    bool large;                              /* reduces colour with sides above T3R_MAX_SIDE, else refuses it */
    picture colour, depth;                   /* the last ones decoded */
    uint32_t whole_width, whole_height;      /* sides of the last colour before it was reduced; 0: none was decoded */
    picture straight_colour, straight_depth; /* the last ones redrawn without distortion */
    picture hidden;                          /* the last depth that bag_pictures_hide() made */
} bag_pictures;

/* Returns a decoder of JPEG, PNG and the PNG of compressedDepth (16UC1 unchanged, 32FC1 by the scale in the message);
 * rgba8, bgra8, 8UC4 and bayer become RGB; pixels that are transparent by half or more become black.
 * `pictures` is initialised with zeros but for `large`, and outlives the recording; call bag_pictures_free() when the
 * recording is closed. */
t3r_image_decoder bag_pictures_decoder(bag_pictures *pictures);
/* Sets depth to 0, none, where the colour image of the frame that was read last is transparent. The frame's depth is of
 * colour's view, redrawn with it if that was straightened, and stays valid until the next call. Returns -1 without
 * memory. */
int bag_pictures_hide(bag_pictures *pictures, t3r_frame *frame, bool straightened);
void bag_pictures_free(bag_pictures *pictures);

#endif
