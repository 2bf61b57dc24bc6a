/* SPDX-License-Identifier: Apache-2.0 */
/* Folders that rosbag2 writes: metadata.yaml lists the files of a bag. */
#ifndef T3R_PLATFORM_RECORDING_FOLDER_H
#define T3R_PLATFORM_RECORDING_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

/* Paths of the files of a recording, in their order. */
typedef struct t3r_recording_files {
    char **paths;
    size_t count;
} t3r_recording_files;

/* Whether the path is such a folder. */
bool t3r_recording_is_folder(const char *path);
/* Lists the MCAP files of such a folder, as metadata.yaml names them; a file is its own list. Returns 0, or -1 with
 * "path: why" in error[]: a file of the folder is missing, or in SQLite, with the command that converts it. Call
 * t3r_recording_files_free() in either case. */
int t3r_recording_files_of(const char *path, t3r_recording_files *out, char *error, size_t error_bytes);
void t3r_recording_files_free(t3r_recording_files *files);

#endif
