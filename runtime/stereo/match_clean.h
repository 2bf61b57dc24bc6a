/* What is wrong with disparities, and what may stand there instead (SPEC.md, "Stereo"). */
#ifndef T3R_MATCH_CLEAN_H
#define T3R_MATCH_CLEAN_H

#include <stdint.h>

#include "match.h"

/* Pixels of either plane whose disparity is not that of the pixel it leads to, within a pixel, lose their confidence;
 * the right plane gets its confidences from the left one's. */
void t3r_match_agree(const t3r_match *match);

/* Regions of less than 1/1024 of the picture, joined where neighbours differ by at most a pixel, lose their confidence.
 * side: 0 left, 1 right. Returns how many pixels. Uses match->work. */
uint32_t t3r_match_speckles(const t3r_match *match, uint32_t side);

/* Trusted pixels among eight trusted neighbours get the median of the nine disparities. Uses match->work. */
void t3r_match_smooth(const t3r_match *match, uint32_t side);

/* Pixels without confidence get the disparity of what surrounds them within T3R_MATCH_REACH pixels, the farther surface
 * where the other picture does not see them, or T3R_NO_DISPARITY; their confidence stays 0. At most 8 T3R_MATCH_REACH
 * steps a pixel. Uses match->work. */
#define T3R_MATCH_REACH 24
void t3r_match_fill(const t3r_match *match, uint32_t side);

#endif
