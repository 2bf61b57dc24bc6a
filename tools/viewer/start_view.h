/* SPDX-License-Identifier: Apache-2.0 */
/* The place from which a scene without frames is first seen. */
#ifndef TRIM3R_TOOLS_VIEWER_START_VIEW_H
#define TRIM3R_TOOLS_VIEWER_START_VIEW_H

#include "scene/scene_file.h"
#include "trim3r.h"

/* The size of its pictures. */
#define START_VIEW_WIDTH 640u
#define START_VIEW_HEIGHT 480u

/* Places a camera of this size in front of the scene so that it frames the scene, with up as the file names it, else
 * -y. Returns 0, or -1 when memory is out. */
int start_view(const scene_file *scene, uint32_t width, uint32_t height, t3r_camera *out);

#endif
