/* Pictures alone, without poses. */
#ifndef TRIM3R_TOOLS_PICTURE_FOLDER_H
#define TRIM3R_TOOLS_PICTURE_FOLDER_H

#include <stddef.h>

#include "import/posed_frame.h"

/* A folder of pictures (.png, .jpg, .jpeg), in the order of their names, numbers in them by value. */
int picture_folder_read(const char *directory, const posed_folder_options *options, posed_folder *out, char *error,
                        size_t error_bytes);

#endif
