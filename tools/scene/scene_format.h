/* A format of scene files. A new one is a source file in formats/ with its row, and the row's name in scene_file.c. */
#ifndef TRIM3R_TOOLS_SCENE_FORMAT_H
#define TRIM3R_TOOLS_SCENE_FORMAT_H

#include <stdio.h>

#include "scene/scene_file.h"
#include "scene/scene_rows.h"

typedef struct scene_format {
    const char *suffix;  /* of its files: ".ply" */
    const char *magic;   /* their first bytes; NULL: they begin with anything, or as those of another row */
    const char *foreign; /* the reason for those that begin otherwise; NULL: as magic */
    scene_axes axes;     /* of the files that are written; the reader tells its own */
    uint32_t degree;     /* of the harmonics that are written at most, 0..3 */
    /* As scene_file_parse(); NULL: not read. */
    int (*parse)(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes);
    /* To a stream whose errors the caller looks at: 0, or -1 with the reason in error[]; NULL: not written. */
    int (*write)(FILE *file, const scene_source *source, char *error, size_t error_bytes);
} scene_format;

#endif
