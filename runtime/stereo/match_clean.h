/* SPDX-License-Identifier: Apache-2.0 */
/* Cleaning of disparities: removing wrong ones and filling holes (SPEC.md, "Stereo"). */
#ifndef T3R_MATCH_CLEAN_H
#define T3R_MATCH_CLEAN_H

#include <stdint.h>

#include "match.h"

/* Removes the confidence of pixels whose disparity differs by more than a pixel from the disparity at its partner. The
 * right plane gets its confidences from the left one. */
void t3r_match_agree(const t3r_match *match);

/* Removes the confidence of regions smaller than 1/1024 of the picture; neighbours are connected if they differ by at
 * most a pixel. side: 0 left, 1 right. Returns the number of pixels. Uses match->work. */
uint32_t t3r_match_speckles(const t3r_match *match, uint32_t side);

/* Replaces trusted pixels with eight trusted neighbours by the median of the nine disparities. Uses match->work. */
void t3r_match_smooth(const t3r_match *match, uint32_t side);

/* Gives pixels without confidence a disparity from trusted pixels within T3R_MATCH_REACH around them, the farther
 * surface where the other picture doesn't see them; or T3R_NO_DISPARITY. Their confidence stays 0. At most 8
 * T3R_MATCH_REACH steps a pixel. Uses match->work. */
#define T3R_MATCH_REACH 24
void t3r_match_fill(const t3r_match *match, uint32_t side);

#endif
