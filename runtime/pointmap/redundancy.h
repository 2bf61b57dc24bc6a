/* SPDX-License-Identifier: Apache-2.0 */
/* Redundancy between views: pixels whose surface another view has measured about as finely or more finely. */
#ifndef T3R_REDUNDANCY_H
#define T3R_REDUNDANCY_H

#include <stdint.h>

#include "pointmap_work.h"
#include "state/views.h"

/* Marks the pixels of view v that another view covers (t3r_is_covered) and returns their number. The other view's
 * pixel on which the point falls must be measured, unmarked and at most 1/32 off in depth. Its footprint z / f must be
 * at most 17/16 as wide if its view comes earlier, and below 16/17 if it comes later. So of two equally good views the
 * earlier one is retained whole. A pixel that covers another is never marked afterwards, so no surface is lost. Call
 * this for the last view first. */
uint32_t t3r_mark_covered(const t3r_view *views, uint32_t count, uint32_t v, int32_t exponent,
                          const t3r_pointmap_work *work);

/* Clears the marks of covering pixels, once all views are marked. */
void t3r_clear_witnesses(const t3r_view *views, uint32_t count);

#endif
