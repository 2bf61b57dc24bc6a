/* Wide depth holes: what the other views measured there, and between the edges of what no view measured. */
#ifndef T3R_BRIDGE_H
#define T3R_BRIDGE_H

#include <stdint.h>

#include "state/views.h"
#include "pointmap_work.h"

/* Gives depth to pixels without one that have known ones within `radius` (0..255; 0 leaves what other views lend) at
 * both ends of their row, column or diagonals. Known is what is measured, filled, or measured by another view and seen
 * from here. Such a pixel becomes T3R_BRIDGED, and T3R_MARK_COVERED too where another view has its surface; it gets
 * nothing where another view sees through it. Reads pose, depth and validity as t3r_depth_fill() leaves them, and the
 * frame's exponent; touches no pixel that has a depth. Returns how many are bridged and not covered.
 *
 * t3r_bridge_lend() for every view first, then t3r_bridge_view() for every view, then t3r_bridge_settle() for every
 * view: three steps, so that a caller may pause between any two views. `settled` has a bit set for each view whose
 * bridges stand already: this view's must agree with them. Per pixel at most 22 steps for each other view and
 * 8 x radius. */
void t3r_bridge_lend(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent,
                     const t3r_pointmap_work *work);
void t3r_bridge_view(const t3r_view *view, uint32_t radius);
uint32_t t3r_bridge_settle(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, uint32_t settled,
                           const t3r_pointmap_work *work);

#endif
