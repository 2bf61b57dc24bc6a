/* SPDX-License-Identifier: Apache-2.0 */
/* Folders of pictures with known cameras, of every kind that posed_folder.c lists, or pictures without poses. Reading a
 * folder gives the list of its frames; the caller reads the pictures. */
#ifndef TRIM3R_TOOLS_POSED_FOLDER_H
#define TRIM3R_TOOLS_POSED_FOLDER_H

#include <stddef.h>

#include "import/frames/posed_frame.h"

/* Returns the options to look at a folder, whose poses or lens import may get from its command line. */
posed_folder_options posed_folder_look(const char *directory);

/* Reads DIR's lists. Returns 0, or -1 with "file: frame: field: what" in error[]. Call posed_folder_close() in either
 * case. */
int posed_folder_open(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                      size_t error_bytes);

#endif
