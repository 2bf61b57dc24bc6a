/* Depth as files of float32. */
#ifndef TRIM3R_TOOLS_RAW_DEPTH_H
#define TRIM3R_TOOLS_RAW_DEPTH_H

#include <stddef.h>
#include <stdint.h>

#include "pictures/picture.h"

typedef enum raw_depth_kind {
    RAW_DEPTH_NONE,   /* the file is a picture */
    RAW_DEPTH_PLAIN,  /* nothing but numbers */
    RAW_DEPTH_COLMAP, /* "width&height&1&" before them, as COLMAP's dense maps have it */
    RAW_DEPTH_EXR,    /* OpenEXR, which exr_depth.h reads: nothing below takes it */
} raw_depth_kind;

/* Of one file: width x height little-endian numbers, in the folder's lengths. */
typedef struct raw_depth {
    raw_depth_kind kind;
    uint32_t width, height; /* of RAW_DEPTH_PLAIN */
    double unit;            /* of the steps that they are rounded to */
} raw_depth;

/* A length in steps of `unit`, to the nearest, halves to even. What is not a number, not positive or beyond 65535 steps
 * becomes 0. */
uint16_t raw_depth_step(float length, double unit);
/* A file as 16-bit grey, each number by raw_depth_step(). 0, or -1 with "path: what" in error[]. */
int raw_depth_read(const char *path, const raw_depth *raw, picture *out, char *error, size_t error_bytes);
/* The same of bytes in memory; the reason has no path. */
int raw_depth_parse(const uint8_t *bytes, size_t count, const raw_depth *raw, picture *out, char *error,
                    size_t error_bytes);
/* The median of a file's positive numbers, or 0: there are none, or the file cannot be read. */
double raw_depth_median(const char *path, const raw_depth *raw);

#endif
