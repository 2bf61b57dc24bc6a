/* Depth as files of float32. */
#ifndef TRIM3R_TOOLS_RAW_DEPTH_H
#define TRIM3R_TOOLS_RAW_DEPTH_H

#include <stddef.h>
#include <stdint.h>

#include "pictures/picture.h"

typedef enum raw_depth_kind {
    RAW_DEPTH_NONE,   /* the file is a picture */
    RAW_DEPTH_PLAIN,  /* only numbers */
    RAW_DEPTH_COLMAP, /* numbers after "width&height&1&", as in COLMAP's dense maps */
    RAW_DEPTH_EXR,    /* OpenEXR: read by exr_depth.h, not by the functions below */
} raw_depth_kind;

/* The format of one file: width x height little-endian numbers, in the folder's lengths. */
typedef struct raw_depth {
    raw_depth_kind kind;
    uint32_t width, height; /* for RAW_DEPTH_PLAIN */
    double unit;            /* step that the numbers are rounded to */
} raw_depth;

/* Returns a length in steps of `unit`, rounded to nearest, halves to even. NaN, lengths that are not positive and
 * lengths beyond 65535 steps become 0. */
uint16_t raw_depth_step(float length, double unit);
/* Reads a file as 16-bit grey, each number by raw_depth_step(). Returns 0, or -1 with "path: what" in error[]. */
int raw_depth_read(const char *path, const raw_depth *raw, picture *out, char *error, size_t error_bytes);
/* The same for bytes in memory; the reason has no path. */
int raw_depth_parse(const uint8_t *bytes, size_t count, const raw_depth *raw, picture *out, char *error,
                    size_t error_bytes);
/* Returns the median of a file's positive numbers; 0 if there are none or the file cannot be read. */
double raw_depth_median(const char *path, const raw_depth *raw);

#endif
