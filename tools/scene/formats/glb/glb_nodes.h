/* SPDX-License-Identifier: Apache-2.0 */
/* The placement of a .glb's Gaussians by its nodes. */
#ifndef TRIM3R_TOOLS_GLB_NODES_H
#define TRIM3R_TOOLS_GLB_NODES_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

#include "scene/scene_turn.h"

/* A point of the mesh becomes scale x rotated point + translation. */
typedef struct glb_placement {
    bool none; /* identity */
    double scale;
    double translation[3];
    scene_turn turn;
} glb_placement;

/* Finds the transform of the node that shows a mesh, with all nodes above it; identity if no node shows the mesh.
 * Returns 0, or -1 with the reason in error[]: a mirror, a non-uniform scale or a shear, two nodes that show the mesh,
 * or nodes that form no tree. */
int glb_find_placement(const cJSON *root, uint32_t mesh_index, glb_placement *out, char *error, size_t error_bytes);

#endif
