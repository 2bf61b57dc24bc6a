/* SPDX-License-Identifier: Apache-2.0 */
/* Uses a scene made elsewhere as context frames: the colours of the recorded views with the depth of its Gaussians,
 * which then are points like any others. */
#ifndef TRIM3R_TOOLS_SCENE_FRAMES_H
#define TRIM3R_TOOLS_SCENE_FRAMES_H

#include <stdint.h>

#include "recording/recording.h"
#include "scene/scene_file.h"

/* Reads a scene to be pruned; flags as for scene_file_read(). Returns an exit status of cli.h after a message. */
int scene_to_prune(const char *path, int flags, scene_file *scene);

/* Memory that the frames point into. */
typedef struct scene_frames {
    uint8_t *rgb[T3R_MAX_VIEWS], *depth[T3R_MAX_VIEWS];
    uint32_t gaussians; /* of the file */
    double seconds;     /* time taken */
} scene_frames;

/* Replaces pictures, depth and cameras of the `count` frames, whose indices are `context`, by the recording's pictures
 * at width x height, undistorted, and the depth of the scene in the file `scene` (splat_depth.h). The scene must be in
 * the recording's world. A view that sees none of it is refused. Returns an exit status of cli.h after a message; call
 * scene_frames_free() in either case, once the frames are no longer used. */
int scene_frames_make(scene_frames *made, const char *scene, int flags, const t3r_recording *recording,
                      const char *path, const uint32_t *context, uint32_t count, uint32_t width, uint32_t height,
                      t3r_capture_frame *frames);
void scene_frames_free(scene_frames *made);

#endif
