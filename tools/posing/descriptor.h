/* SPDX-License-Identifier: Apache-2.0 */
/* What a picture shows around a place: 256 comparisons of grey levels, turned by the patch's own direction. */
#ifndef TRIM3R_TOOLS_POSING_DESCRIPTOR_H
#define TRIM3R_TOOLS_POSING_DESCRIPTOR_H

#include <stdint.h>

/* Pixels that a place must be away from the picture's edges. */
#define DESCRIPTOR_BORDER 18u

/* Sums over 5 x 5 pixels (0 within two pixels of the edges): what is compared. Rows without gaps. */
void descriptor_smooth(const uint8_t *grey, uint32_t width, uint32_t height, uint16_t *smoothed);

/* The comparisons at pixel (x, y) of both, DESCRIPTOR_BORDER or more from every edge. */
void descriptor_compare(const uint8_t *grey, const uint16_t *smoothed, uint32_t width, uint32_t x, uint32_t y,
                        uint64_t comparisons[4]);

#endif
