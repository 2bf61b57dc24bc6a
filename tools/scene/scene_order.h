/* The order in which formats that pack neighbours together write the Gaussians of a scene. */
#ifndef TRIM3R_TOOLS_SCENE_ORDER_H
#define TRIM3R_TOOLS_SCENE_ORDER_H

#include "scene/scene_rows.h"

/* Indices along a Z-order curve (Morton) through the box of the means, 10 bits an axis; of equals the first comes
 * first. free() it; NULL: out of memory. */
uint32_t *scene_order_morton(const scene_source *source);

#endif
