/* SPDX-License-Identifier: Apache-2.0 */
/* Writes the starting point of another optimiser: a build's context views and points as a COLMAP model. */
#ifndef TRIM3R_TOOLS_COLMAP_START_H
#define TRIM3R_TOOLS_COLMAP_START_H

#include <stdbool.h>

#include "cli/files/whole_folder.h"
#include "reconstruction/reconstruction.h"
#include "recording/recording.h"

typedef struct colmap_start {
    const t3r_recording *recording;
    const char *path; /* the recording's, for messages */
    const t3r_scene *scene;
    const reconstruction_account *account; /* the views, with the poses that the build used */
    bool local, sourced;                   /* as in colmap_model */
} colmap_start;

/* Writes the model into a folder that was begun, and commits it; `name` is the folder's, for messages. Returns an exit
 * status of cli.h. */
int colmap_start_write(const colmap_start *start, whole_folder *folder, const char *name);

#endif
