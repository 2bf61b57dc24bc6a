/* SPDX-License-Identifier: Apache-2.0 */
/* The kind of input at a path, as import reads it: one answer for all commands. */
#ifndef TRIM3R_TOOLS_IMPORT_SOURCE_H
#define TRIM3R_TOOLS_IMPORT_SOURCE_H

#include "recording/recording.h"

typedef enum import_source {
    IMPORT_RECORDING, /* an MCAP file, or a folder of rosbag2 */
    IMPORT_FOLDER,    /* a folder of pictures and lists (posed_folder.h), or no path at all */
    IMPORT_FOREIGN    /* a picture or a video in the place of a recording */
} import_source;

/* *advice: how a foreign file is converted. */
import_source import_source_of(const char *path, const char **advice);

/* Opens the recording at a path, for commands that build from one. Returns NULL after a message on stderr, which says
 * what the path is and which command converts it. Close it with t3r_recording_close(). */
t3r_recording *import_source_open(const char *path);

#endif
