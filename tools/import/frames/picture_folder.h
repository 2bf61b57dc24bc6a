/* SPDX-License-Identifier: Apache-2.0 */
/* Pictures without poses. */
#ifndef TRIM3R_TOOLS_PICTURE_FOLDER_H
#define TRIM3R_TOOLS_PICTURE_FOLDER_H

#include <stddef.h>

#include "import/frames/posed_frame.h"

/* Whether the folder holds a picture that is read. */
bool picture_folder_is(const char *directory);

/* Reads a folder of pictures (.png, .jpg, .jpeg), in the order of their names, with numbers in names by value. */
int picture_folder_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                        size_t error_bytes);

/* Adds to `out` the pictures and videos in DIR that are not read, with the command that converts each (foreign_file.h).
 * Returns 0, or -1 when out of memory. */
int picture_folder_foreign(const char *directory, left_out *out);

/* Returns the name of a bag in a folder without pictures, on the heap; NULL: there is none. */
char *picture_folder_bag(const char *directory);

/* Returns the path of the first folder in DIR that holds pictures, on the heap; NULL: there is none. */
char *picture_folder_below(const char *directory);

/* Adds to out->left_out.frames, with the reason, every picture in DIR/PLACE that is no frame's image: pictures that the
 * folder's lists omit. Returns 0, or -1 with a reason in error[]. */
int picture_folder_rest(const char *directory, const char *place, const char *why, posed_folder *out, char *error,
                        size_t error_bytes);

#endif
