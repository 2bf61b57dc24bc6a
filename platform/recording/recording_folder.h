/* SPDX-License-Identifier: Apache-2.0 */
/* Folders that rosbag2 writes: metadata.yaml lists the files of a bag. */
#ifndef T3R_PLATFORM_RECORDING_FOLDER_H
#define T3R_PLATFORM_RECORDING_FOLDER_H

#include <stdbool.h>
#include <stddef.h>

/* Whether the path is such a folder. */
bool t3r_recording_is_folder(const char *path);
/* Returns the path of the folder's one MCAP file, to be freed; NULL with "path: why" in error[], which names the
 * command that makes one, for several files and for other formats. */
char *t3r_recording_folder_file(const char *path, char *error, size_t error_bytes);

#endif
