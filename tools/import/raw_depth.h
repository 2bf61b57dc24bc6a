/* Depth as files of float32. */
#ifndef TRIM3R_TOOLS_RAW_DEPTH_H
#define TRIM3R_TOOLS_RAW_DEPTH_H

#include <stddef.h>
#include <stdint.h>

#include "pictures/picture.h"

/* Of one file: width x height little-endian numbers, in the folder's lengths. */
typedef struct raw_depth {
    uint32_t width, height; /* 0: the file is a picture */
    double unit;            /* of the steps that they are rounded to */
} raw_depth;

/* As 16-bit grey, rounded to the nearest step. What is not a number, not positive or beyond 65535 steps becomes 0. 0,
 * or -1 with "path: what" in error[]. */
int raw_depth_read(const char *path, const raw_depth *raw, picture *out, char *error, size_t error_bytes);

#endif
