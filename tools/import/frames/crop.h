/* SPDX-License-Identifier: Apache-2.0 */
/* Crops pictures and depth to another aspect, and resizes them as the image stage does. */
#ifndef TRIM3R_TOOLS_CROP_H
#define TRIM3R_TOOLS_CROP_H

#include <stdint.h>

#include "pictures/picture.h"
#include "trim3r_host.h"

#define IMPORT_LEAST_SIDE 2u /* of t3r_frame, and so of a crop */

/* Returns the largest centred rectangle of width:height in a picture. Its other side is rounded to the nearest pixel;
 * an odd pixel left over goes to the right or bottom. */
t3r_crop import_largest_crop(uint32_t picture_width, uint32_t picture_height, uint32_t width, uint32_t height);

/* Returns the same share of a picture of another resolution, each edge at the nearest pixel. */
t3r_crop import_crop_in_proportion(const t3r_crop *crop, uint32_t from_width, uint32_t from_height, uint32_t width,
                                   uint32_t height);

/* Converts the part of a picture of 8 bits to RGB of width x height, rows without gaps. Returns -1 without memory. */
int import_crop_colour(const picture *in, const t3r_crop *crop, uint32_t width, uint32_t height, uint8_t *rgb);

/* Converts the part of depth, 16-bit steps in little-endian bytes, to width x height steps. Returns -1 if a side of the
 * part is below IMPORT_LEAST_SIDE. */
int import_crop_depth(const void *z16, uint32_t stride_bytes, const t3r_crop *crop, uint32_t width, uint32_t height,
                      uint16_t *depth);

#endif
