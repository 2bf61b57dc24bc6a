/* SPDX-License-Identifier: Apache-2.0 */
/* `trim3r info SCENE.ply...`: the contents of scene files, and the widths of their Gaussians. */
#ifndef TRIM3R_TOOLS_SCENE_INFO_H
#define TRIM3R_TOOLS_SCENE_INFO_H

#include <stdbool.h>
#include <stdint.h>

#include "recording/recording.h"

#define SCENE_INFO_MOST 24u

typedef struct scene_info_request {
    const char *const *scenes; /* 1..SCENE_INFO_MOST paths */
    uint32_t scene_count;
    const t3r_recording *recording; /* NULL: no scales in pixels */
    const char *recording_path;     /* for messages */
    uint32_t view;                  /* the frame whose pixels are used */
    const char *svg;                /* NULL: no picture */
    int flags;                      /* for scene_file_read() */
    bool json;
} scene_info_request;

/* Returns an exit status of cli.h. */
int scene_info(const scene_info_request *request);

#endif
