/* Loads a scene from a file into the runtime's arena. */
#ifndef TRIM3R_TOOLS_SCENE_APPEND_H
#define TRIM3R_TOOLS_SCENE_APPEND_H

#include "scene/scene_file.h"

/* Replaces the scene in the arena. `eye`: harmonics show the colours seen from it; NULL = degree 0 only. *index
 * receives the Gaussian that was refused. */
t3r_status scene_append_all(t3r_runtime *runtime, const scene_file *scene, const t3r_camera *eye, uint32_t *index);

#endif
