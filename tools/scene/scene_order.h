/* SPDX-License-Identifier: Apache-2.0 */
/* The order of Gaussians in formats that pack neighbours together. */
#ifndef TRIM3R_TOOLS_SCENE_ORDER_H
#define TRIM3R_TOOLS_SCENE_ORDER_H

#include "scene/scene_rows.h"

/* Returns indices along a Z-order curve (Morton) through the bounding box of the means, 10 bits per axis; ties keep
 * their order. Gaussians far outside the scene, such as a backdrop, follow the others, each shell by its own box.
 * free() it; NULL: out of memory. */
uint32_t *scene_order_morton(const scene_source *source);

#endif
