/* SPDX-License-Identifier: Apache-2.0 */
/* Rewrites a recording, or a bag from elsewhere: complete indexed frames, decoded images, composed poses,
 * registered depth, cuts repaired. */
#ifndef TRIM3R_TOOLS_RECORDING_IMPORT_H
#define TRIM3R_TOOLS_RECORDING_IMPORT_H

#include "cli/options/recording_options.h"
#include "import/bags/bag_options.h"
#include "import/estimation/poses.h"

typedef struct recording_import_request {
    const char *input, *output, *source; /* source: stored in the new recording as its origin */
    uint32_t width, height;              /* 0: as the frames are */
    poses_source poses;
    bool keeps_border;            /* the border of one colour that all images have is not left out */
    const t3r_camera *intrinsics; /* of the colour images; NULL: those of camera_info */
    uint64_t depth_unit_q40;      /* 0: 0.001 */
    const bag_options *bag;
    const recording_options *stored;
    bool json;
    bool quiet; /* prints nothing but errors */
} recording_import_request;

/* Writes the recording and prints what was used for what. Returns an exit status of cli.h. */
int recording_import(const recording_import_request *request);

#endif
