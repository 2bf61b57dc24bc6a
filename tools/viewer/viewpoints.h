/* SPDX-License-Identifier: Apache-2.0 */
/* Viewpoints of a page: recorded frames, or a place in front of a scene without frames. */
#ifndef TRIM3R_TOOLS_VIEWER_VIEWPOINTS_H
#define TRIM3R_TOOLS_VIEWER_VIEWPOINTS_H

#include <stdint.h>

#include <stdbool.h>
#include <stdint.h>

#include "recording/recording.h"
#include "viewer/bundle.h"
#include "viewer/bundle_layout.h"
#include "viewer/page.h"

typedef struct viewpoints {
    bundle_frame frames[BUNDLE_MOST_FRAMES];
    char names[BUNDLE_MOST_FRAMES][PAGE_NAME_BYTES];
    uint32_t count;
} viewpoints;

/* Adds a recorded frame of this size. with_depth: also its depth, if it has one. Returns an exit status of cli.h after
 * a message; viewpoints_free() is due either way. */
int viewpoints_add(viewpoints *v, const t3r_recording *recording, const char *path, uint32_t index, uint32_t width,
                   uint32_t height, bool with_depth);

/* Finds the frame in the middle of the first two context frames. Returns false if there is none between them. */
bool viewpoints_middle(const uint32_t *context, uint32_t count, uint32_t *middle);

/* Adds a viewpoint in front of the scene that frames it, with up as the file names it, else -y. Returns an exit status
 * of cli.h after a message. */
int viewpoints_add_before(viewpoints *v, const scene_file *scene, uint32_t width, uint32_t height);

void viewpoints_free(viewpoints *v);

#endif
