/* SPDX-License-Identifier: Apache-2.0 */
/* Scenes, point clouds and meshes that are not read, and what makes a scene of them. */
#ifndef TRIM3R_TOOLS_FOREIGN_SCENE_H
#define TRIM3R_TOOLS_FOREIGN_SCENE_H

/* Returns "KIND is not read; COMMAND makes ... of it" for a file with the suffix of such a kind; NULL for others. */
const char *foreign_scene_of_name(const char *path);

#endif
