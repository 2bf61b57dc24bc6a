/* The compressed images of a bag, decoded for its import. */
#ifndef TRIM3R_TOOLS_BAG_PICTURES_H
#define TRIM3R_TOOLS_BAG_PICTURES_H

#include "pictures/picture.h"
#include "recording/recording.h"

typedef struct bag_pictures {
    picture colour, depth; /* the last ones */
} bag_pictures;

/* JPEG, PNG and the PNG of compressedDepth, 16UC1 as it is and 32FC1 by the scale that the message gives. `pictures`
 * begins with zeros and outlives the recording; bag_pictures_free() when that is closed. */
t3r_image_decoder bag_pictures_decoder(bag_pictures *pictures);
void bag_pictures_free(bag_pictures *pictures);

#endif
