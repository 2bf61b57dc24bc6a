/* SPDX-License-Identifier: Apache-2.0 */
/* The orientation and the lens of a camera when it took a picture. */
#ifndef TRIM3R_TOOLS_EXIF_H
#define TRIM3R_TOOLS_EXIF_H

#include <stddef.h>
#include <stdint.h>

#define EXIF_UPRIGHT 1u
#define EXIF_SWAPS_FROM 5u /* from this orientation on, turning swaps the sides */

typedef struct exif_facts {
    uint32_t orientation; /* 1 to 8; EXIF_UPRIGHT where none is stated */
    double focal_35mm; /* focal length in mm that gives a film of 36 x 24 mm the same diagonal field of view, as it is
                          stated or by the sensor's size; 0 where neither is stated */
} exif_facts;

/* Reads a block of EXIF: a TIFF header and its directories. */
exif_facts exif_read(const uint8_t *tiff, size_t count);

/* Returns the focal length in pixels of a picture of that size; focal_35mm as above. */
double exif_focal_pixels(double focal_35mm, uint32_t width, uint32_t height);

#endif
