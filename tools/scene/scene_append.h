/* SPDX-License-Identifier: Apache-2.0 */
/* Loads a scene from a file into the runtime's arena. */
#ifndef TRIM3R_TOOLS_SCENE_APPEND_H
#define TRIM3R_TOOLS_SCENE_APPEND_H

#include "scene/scene_file.h"

/* A camera, and the size of its picture. */
typedef struct scene_eye {
    const t3r_camera *camera;
    uint32_t width, height;
} scene_eye;

/* Replaces the scene in the arena by what the eye sees of it: colours of harmonics, opacities of mip-splatting. NULL:
 * colours of degree 0 and opacities as they are. *index receives the Gaussian that was refused. */
t3r_status scene_append_all(t3r_runtime *runtime, const scene_file *scene, const scene_eye *eye, uint32_t *index);

#endif
