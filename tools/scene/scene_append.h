/* SPDX-License-Identifier: Apache-2.0 */
/* Loads a scene from a file into the runtime's arena. */
#ifndef TRIM3R_TOOLS_SCENE_APPEND_H
#define TRIM3R_TOOLS_SCENE_APPEND_H

#include "scene/scene_file.h"
#include "scene/seen_gaussian.h"

/* A camera, and the size of its picture. */
typedef struct scene_eye {
    const t3r_camera *camera;
    uint32_t width, height;
} scene_eye;

/* Returns where the eye sees the scene from. */
seen_from scene_seen_from(const scene_file *scene, const scene_eye *eye);
/* Whether the eye sees another scene than the file has. */
bool scene_differs(const scene_file *scene, const seen_from *from);

/* Replaces the scene in the arena by what the eye sees of it: colours of harmonics, opacities of mip-splatting, and a
 * frame of the view's own if the scene's cannot show it. NULL: colours of degree 0, opacities and frame as they are.
 * *index receives the Gaussian that was refused. */
t3r_status scene_append_all(t3r_runtime *runtime, const scene_file *scene, const scene_eye *eye, uint32_t *index);

#endif
