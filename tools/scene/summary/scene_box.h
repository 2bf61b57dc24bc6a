/* SPDX-License-Identifier: Apache-2.0 */
/* Where a scene is, as seen upright: the box that views frame. */
#ifndef TRIM3R_TOOLS_SCENE_BOX_H
#define TRIM3R_TOOLS_SCENE_BOX_H

#include "scene/scene_file.h"
#include "scene/scene_turn.h"

/* Axes are upright: x right, y down, z forward. Along each, the box holds the scene without a twentieth of the
 * Gaussians at either end, widened by a quarter. */
typedef struct scene_box {
    scene_turn upright; /* from the scene's axes */
    double middle[3];   /* from the origin of the scene's frame, in world units */
    double half[3];     /* half of the sides, in world units */
} scene_box;

/* Finds the box, with `up` as the axis that points up. Returns 0, or -1 when memory is out. */
int scene_box_of(const scene_file *scene, scene_up up, scene_box *out);

/* Turns an upright position back to the world, origin of the frame included. */
void scene_box_world(const scene_box *box, const scene_file *scene, const double upright[3], double world[3]);

#endif
