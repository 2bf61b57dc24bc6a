/* Stage depth: validity of measured depth, and small holes filled. */
#ifndef T3R_DEPTH_H
#define T3R_DEPTH_H

#include <stdint.h>

#include "views.h"

/* Two depths a and b belong to one surface when |a - b| x this <= the lesser of them. */
#define T3R_DEPTH_AGREE 16

/* Confidence from depth: T3R_CONFIDENCE_MEASURED where there is one, else T3R_CONFIDENCE_NONE. */
void t3r_depth_confidence(t3r_view *view);

/* Fills pixels without depth that have measured ones within `radius` (0..8; 0 fills nothing) on both sides, in
 * their row or their column; they get T3R_CONFIDENCE_FILLED and never seed others. Returns how many. Two sides
 * that agree are interpolated; across an edge the side of the likelier colour is taken whole. Reads view->colour,
 * depth and confidence. At most 4 x radius steps a pixel. */
uint32_t t3r_depth_fill(t3r_view *view, uint32_t radius);

#endif
