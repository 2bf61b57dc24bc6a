/* Cameras in floats, for the host's work on scenes. */
#ifndef TRIM3R_TOOLS_SCENE_SPLAT_CAMERA_H
#define TRIM3R_TOOLS_SCENE_SPLAT_CAMERA_H

#include <stdint.h>

#include "trim3r.h"

typedef struct splat_camera {
    uint32_t width, height;
    double fx, fy, cx, cy; /* pixels; (0, 0) is the centre of the top-left pixel */
    double rotation[9];    /* row-major, camera to scene */
    double position[3];    /* scene units */
} splat_camera;

/* Returns the pinhole camera of a t3r_camera for a scene in this frame. */
splat_camera splat_camera_of(const t3r_camera *camera, const t3r_scene_frame *frame, uint32_t width, uint32_t height);

#endif
