/* SPDX-License-Identifier: Apache-2.0 */
/* The command line of `trim3r capture`, checked as a whole. */
#ifndef TRIM3R_TOOLS_CAPTURE_OPTIONS_H
#define TRIM3R_TOOLS_CAPTURE_OPTIONS_H

#include <stdbool.h>
#include <stdint.h>

#include "cli/options/recording_options.h"
#include "reconstruction/live/live_options.h"
#include "reconstruction/reconstruction.h"
#include "trim3r_capture.h"

typedef struct capture_options {
    const char *source, *output, *poses, *pose_topic;
    t3r_capture_settings settings;
    t3r_recorded_camera intrinsics;
    bool has_intrinsics, fisheye;
    bool has_offset, estimate, has_centre;
    int64_t offset_ns; /* given, or the centre of an estimate */
    const char *scene;
    recording_options stored; /* how the recording stores messages */
    bool list, json, sync, hash, local, quiet, strict, streams;
    live_options live;
    uint32_t every, frames;
    uint64_t max_bytes;
    uint64_t poses_left_out; /* filled in when the poses are read */
    double seconds, reconnect_seconds;
    reconstruction_options build;
    uint64_t given; /* a bit for each KEY_* on the command line */
} capture_options;

#define CAPTURE_MOST_OFFSET_S INT64_C(4000000000) /* of clocks, in either direction */

/* Reads the command line; an option that is wrong, or that the source would ignore, ends the process with a message.
 * With `list` nothing else may be used. */
void capture_options_read(int argc, char **argv, capture_options *o);

#endif
