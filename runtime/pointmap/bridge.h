/* SPDX-License-Identifier: Apache-2.0 */
/* Bridging of wide depth holes: depth measured by other views, or interpolated from the edges of the hole. */
#ifndef T3R_BRIDGE_H
#define T3R_BRIDGE_H

#include <stdint.h>

#include "pointmap_work.h"
#include "state/views.h"

/* Gives depth to pixels that have none, but have known pixels within `radius` (0..255; 0: take only depth of other
 * views) at both ends in their row, column or a diagonal. Known pixels are measured, filled, or measured by another
 * view and visible from this one. Such a pixel becomes T3R_BRIDGED, and also T3R_MARK_COVERED where another view has
 * its surface. It gets no depth where another view sees through it. Reads pose, depth and validity as t3r_depth_fill()
 * leaves them, and the frame's exponent. Pixels that have a depth don't change. Returns how many pixels are bridged and
 * not covered.
 *
 * Call t3r_bridge_lend() for every view first, then t3r_bridge_view() for every view, then t3r_bridge_settle() for
 * every view. The steps are separate so that a caller may pause between any two views. `settled` has a bit for each
 * view whose bridges are final: this view's bridges must agree with them. A pixel takes at most 22 steps for each other
 * view, and as many whatever the radius, but for the first and last rows of a worker's tasks, which take 6 x radius. */
void t3r_bridge_lend(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent,
                     const t3r_pointmap_work *work);
void t3r_bridge_view(const t3r_view *view, uint32_t radius, const t3r_pointmap_work *work);
uint32_t t3r_bridge_settle(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent, uint32_t settled,
                           const t3r_pointmap_work *work);

#endif
