/* SPDX-License-Identifier: Apache-2.0 */
/* The kind of input at a path, as import reads it: one answer for all commands. */
#ifndef TRIM3R_TOOLS_IMPORT_SOURCE_H
#define TRIM3R_TOOLS_IMPORT_SOURCE_H

typedef enum import_source {
    IMPORT_RECORDING, /* an MCAP file, or a folder of rosbag2 */
    IMPORT_FOLDER,    /* a folder of pictures and lists (posed_folder.h), or no path at all */
    IMPORT_FOREIGN    /* a picture or a video in the place of a recording */
} import_source;

/* *advice: how a foreign file is converted. */
import_source import_source_of(const char *path, const char **advice);

#endif
