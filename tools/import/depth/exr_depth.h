/* Depth as OpenEXR: one channel of half or float32. A build without the library refuses such files with the reason. */
#ifndef TRIM3R_TOOLS_EXR_DEPTH_H
#define TRIM3R_TOOLS_EXR_DEPTH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "pictures/picture.h"

/* Whether a file is OpenEXR, by its suffix. */
bool exr_depth_is(const char *name);
/* Returns NULL, or why this build reads no OpenEXR, and what to install. */
const char *exr_depth_missing(void);

/* Reads a file as 16-bit grey in steps of `unit`, which is in the lengths of the file; raw_depth_step() has the
 * rounding. A file whose lengths are all outside 1..65535 steps is refused. Returns 0, or -1 with "path: what" in
 * error[]. */
int exr_depth_read(const char *path, double unit, picture *out, char *error, size_t error_bytes);
/* The same for a file's bytes in memory; the reason has no path. */
int exr_depth_parse(const uint8_t *bytes, size_t count, double unit, picture *out, char *error, size_t error_bytes);
/* Reads the sides without decoding; errors as for exr_depth_read(). */
int exr_depth_size(const char *path, uint32_t *width, uint32_t *height, char *error, size_t error_bytes);

#endif
