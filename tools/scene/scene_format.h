/* SPDX-License-Identifier: Apache-2.0 */
/* A format of scene files. A new one needs a source file in formats/ with its row, and the row's name in
 * store/scene_formats.c. */
#ifndef TRIM3R_TOOLS_SCENE_FORMAT_H
#define TRIM3R_TOOLS_SCENE_FORMAT_H

#include <stdio.h>

#include "scene/scene_file.h"
#include "scene/scene_rows.h"

typedef struct scene_format {
    const char *suffix;     /* suffix of its files: ".ply" */
    const char *magic;      /* first bytes of its files; NULL: any, or the same as another row's */
    const char *foreign;    /* error for files with other first bytes; NULL: as magic */
    scene_axes axes;        /* of written files; the reader knows its own */
    uint32_t degree;        /* highest degree of harmonics that is written, 0..3 */
    double harmonics;       /* the largest coefficient above degree 0 that is written; 0: any */
    scene_bounds colour;    /* of colours of degree 0 that are written (scene_row_colour()); both 0: any */
    scene_bounds log_scale; /* of scales that are written; both 0: any */
    bool holds_origin;      /* a file can say where its origin is in the world */
    bool holds_mip;         /* a file can say that its opacities are those of mip-splatting */
    bool holds_backdrop;    /* a file can say which of its Gaussians are a rim or a backdrop */
    bool shares_bits;       /* the farthest Gaussian decides how exactly the others' positions are written */
    /* Hands the rows to the sink, and returns what it returns; -1 with the reason in error[] if the bytes are no such
     * file. NULL: not read. */
    int (*parse)(const uint8_t *bytes, size_t count, const scene_sink *sink, char *error, size_t error_bytes);
    /* Writes to a stream whose errors the caller checks. Returns 0, or -1 with the reason in error[]; NULL: not
     * written. */
    int (*write)(FILE *file, const scene_source *source, char *error, size_t error_bytes);
} scene_format;

#endif
