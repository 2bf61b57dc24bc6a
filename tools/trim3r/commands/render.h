/* SPDX-License-Identifier: Apache-2.0 */
/* Options of `trim3r render`, and the views that they name. */
#ifndef TRIM3R_TOOLS_COMMANDS_RENDER_H
#define TRIM3R_TOOLS_COMMANDS_RENDER_H

#include <stdbool.h>
#include <stdint.h>

#include "import/viewpoint.h"
#include "reconstruction/reconstruction.h"
#include "scene/scene_file.h"
#include "scene/scene_turn.h"

typedef struct render_options {
    const char *scene, *recording;
    const char *pose, *trajectory;
    const char *output, *depth, *alpha;
    bool has_view, has_size, has_fov, strict, json;
    uint32_t view;
    uint32_t orbit; /* views of a turntable; 0 = none */
    double arc;     /* degrees of a part of a turn; 0 = the whole */
    scene_up up;    /* of the turntable; T3R_UP_UNKNOWN = as the scene names it */
    uint32_t width, height;
    double fov_degrees;
    double rate;       /* pictures a second of a video; 0 = that of the camera path, or RENDER_RATE */
    double depth_unit; /* world units a step of the depth picture */
    double most_ms;    /* of a view; 0 = it may take any time */
    reconstruction_options settings;
} render_options;

/* A turntable without another lens: angle in degrees, and size. */
#define RENDER_FOV 60
#define RENDER_WIDTH 640
#define RENDER_HEIGHT 480
#define RENDER_RATE 24

/* Finds the views of the options; a turntable is about the scene. Returns an exit status of cli.h. */
int render_views(const render_options *o, const scene_file *scene, viewpoint_list *views);

#endif
