/* Pictures alone, without poses. */
#ifndef TRIM3R_TOOLS_PICTURE_FOLDER_H
#define TRIM3R_TOOLS_PICTURE_FOLDER_H

#include <stddef.h>

#include "import/folders/posed_frame.h"

/* A folder of pictures (.png, .jpg, .jpeg), in the order of their names, numbers in them by value. */
int picture_folder_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                        size_t error_bytes);

/* Adds to out->left_out every picture in DIR/PLACE that is not the image of a frame, with the reason: pictures that the
 * folder's lists pass over. 0, or -1 with a reason in error[]. */
int picture_folder_rest(const char *directory, const char *place, const char *why, posed_folder *out, char *error,
                        size_t error_bytes);

#endif
