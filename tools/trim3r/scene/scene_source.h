/* SPDX-License-Identifier: Apache-2.0 */
/* The input of `trim3r scene`: pictures, a folder that import knows, a bag or a recording. */
#ifndef TRIM3R_TOOLS_SCENE_SOURCE_H
#define TRIM3R_TOOLS_SCENE_SOURCE_H

#include <stdbool.h>
#include <stdint.h>

typedef struct scene_source {
    const char *kind;  /* "pictures", "Record3D", "a bag", "a recording" */
    bool is_recording; /* build reads it without import, once its poses are known */
    uint32_t frames, posed, with_depth;
    uint32_t width, height; /* of the first frame */
} scene_source;

/* Looks at the input without changing anything. Returns an exit status of cli.h. */
int scene_source_look(scene_source *source, const char *path);

#endif
