/* SPDX-License-Identifier: Apache-2.0 */
/* Files that are not read as scenes, and what makes a scene of them. */
#ifndef TRIM3R_TOOLS_FOREIGN_SCENE_H
#define TRIM3R_TOOLS_FOREIGN_SCENE_H

/* Returns "KIND is not read; COMMAND makes ... of it" for a file with the suffix of such a kind; NULL for others. */
const char *foreign_scene_of_name(const char *path);
/* Returns "KIND, not a scene: COMMAND makes a scene of ..." for a picture, a video or a recording, by its first bytes;
 * NULL for other files. */
const char *foreign_scene_of_start(const char *path);

#endif
