/* SPDX-License-Identifier: Apache-2.0 */
/* Stage depth: validity of measured depth, and filling of small holes. */
#ifndef T3R_DEPTH_H
#define T3R_DEPTH_H

#include <stdbool.h>
#include <stdint.h>

#include "core/workers.h"
#include "state/views.h"

/* Whether two depths of a view, in its steps, belong to one surface: |a - b| <= 1/16 of the lesser. */
static inline bool t3r_same_surface(uint16_t a, uint16_t b)
{
    int32_t difference = a > b ? a - b : b - a;
    return 16 * difference <= (a < b ? a : b);
}

/* Sets validity from depth: T3R_MEASURED where there is one, else T3R_NO_DEPTH. */
void t3r_depth_validity(t3r_view *view);

/* Fills pixels without depth that have measured ones within `radius` (0..8; 0 fills nothing) on both sides, in their
 * row or their column. Filled pixels become T3R_FILLED and are never a source for others. Interpolates if both sides
 * agree; across an edge takes the side of the more similar colour. Reads view->colour, depth and validity. At most
 * 4 x radius steps a pixel. */
void t3r_depth_fill(const t3r_view *view, uint32_t radius, const t3r_workers *workers);

#endif
