/* A format of scene files. A new one is a source file with its row, and the row's name in scene_file.c. */
#ifndef TRIM3R_TOOLS_SCENE_FORMAT_H
#define TRIM3R_TOOLS_SCENE_FORMAT_H

#include <stdio.h>

#include "scene/scene_file.h"

typedef struct scene_format {
    const char *suffix;  /* of its files: ".ply" */
    const char *magic;   /* their first bytes; NULL: they begin with anything */
    const char *foreign; /* the reason for those that begin otherwise */
    /* As scene_file_parse(); NULL: not read. */
    int (*parse)(const uint8_t *bytes, size_t count, scene_file *out, char *error, size_t error_bytes);
    /* As scene_file_write(), to a stream whose errors the caller looks at; NULL: not written. */
    void (*write)(FILE *file, const t3r_scene *scene, int flags, const char *note);
} scene_format;

#endif
