/* Where the nodes of a .glb put its Gaussians. */
#ifndef TRIM3R_TOOLS_GLB_NODES_H
#define TRIM3R_TOOLS_GLB_NODES_H

#include <cjson/cJSON.h>
#include <stdbool.h>
#include <stddef.h>

#include "scene/scene_turn.h"

/* A point of the mesh becomes scale x turned point + translation. */
typedef struct glb_placement {
    bool none; /* nothing moves it */
    double scale;
    double translation[3];
    scene_turn turn;
} glb_placement;

/* Of the node that shows a mesh, with all nodes above it; none where no node shows it. 0, or -1 with the reason in
 * error[]: a mirror, scales that differ or a shear, two nodes that show the mesh, or nodes that are no tree. */
int glb_find_placement(const cJSON *root, uint32_t mesh_index, glb_placement *out, char *error, size_t error_bytes);

#endif
