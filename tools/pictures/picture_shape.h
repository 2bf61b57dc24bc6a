/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures turned upright, made smaller, and their pixels without content. */
#ifndef TRIM3R_TOOLS_PICTURE_SHAPE_H
#define TRIM3R_TOOLS_PICTURE_SHAPE_H

#include "pictures/picture.h"
#include "trim3r_host.h"

/* Turns an 8-bit picture as its orientation demands. Returns 0, or -1 when out of memory. */
int picture_turn(picture *p);

/* Averages an 8-bit picture over squares of n x n pixels, of which only valid ones count; a square is valid if half of
 * it is. Pixels beyond the last whole square are dropped. */
void picture_reduce(picture *p, uint32_t n);
/* Returns the least n that makes both sides at most T3R_MAX_SIDE; 1 for pictures that are that small. */
uint32_t picture_reduction(uint32_t width, uint32_t height);

/* Keeps the part of a picture. */
void picture_crop(picture *p, const t3r_crop *part);

/* Marks the black pixels of an 8-bit picture invalid, and keeps those that are. Returns 0, or -1 when out of memory. */
int picture_keep_bright(picture *p);

/* Sets invalid pixels of an 8-bit picture to 0. Returns whether any is valid. */
bool picture_blacken(picture *p);

/* Whether the pixel under the point (x, y) of `of`, a picture of the same view, is valid in p. */
bool picture_valid_at(const picture *p, uint32_t x, uint32_t y, const picture *of);

#endif
