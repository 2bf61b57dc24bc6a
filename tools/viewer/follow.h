/* SPDX-License-Identifier: Apache-2.0 */
/* Answers to the page of a growing map: the page, the map, and the lines of its run. */
#ifndef TRIM3R_TOOLS_VIEWER_FOLLOW_H
#define TRIM3R_TOOLS_VIEWER_FOLLOW_H

#include "viewer/page.h"
#include "viewer/server.h"

typedef struct viewer_follow {
    char *page; /* the text at / */
    size_t page_bytes;
    const bundle *data; /* of the page; the map replaces its scene */
    const char *map;    /* a scene file that another program replaces as a whole; NULL = nothing is followed */
    const char *lines;  /* a file of JSON lines that grows (live_row.h) */
    int scene_flags;    /* for scene_file_read() */
} viewer_follow;

/* Answers /, /map with the newest map as a bundle, and /lines?N with the lines from byte N on, after a line of the
 * offset where they begin (0 if the file has become shorter) and the version of the map's file. `user` is a
 * viewer_follow. */
server_answer viewer_follow_find(void *user, const char *path);

#endif
