/* SPDX-License-Identifier: Apache-2.0 */
/* Kinds of files that the commands write, recognised by their first bytes. */
#ifndef TRIM3R_TOOLS_FILE_KIND_H
#define TRIM3R_TOOLS_FILE_KIND_H

/* A set of kinds; one bit each. */
typedef enum file_kind {
    FILE_RECORDING = 1,
    FILE_SCENE = 2,
    FILE_PICTURE = 4, /* PNG */
    FILE_SVG = 8,
    FILE_PAGE = 16, /* HTML */
    FILE_TABLE = 32,
    FILE_WEIGHTS = 64,
    FILE_SOURCE = 128,  /* a head as C source */
    FILE_LINES = 256,   /* JSON objects of a stream's frames, one a line */
    FILE_STATE = 512,   /* of a stream */
    FILE_HEADER = 1024, /* a plan as C */
    FILE_VIDEO = 2048,
    FILE_OTHER = 4096, /* none of these */
} file_kind;

#define FILE_KINDS 13

/* Returns the kind of an existing file; 0 = no file or an empty one, which fits any kind. */
file_kind file_kind_of(const char *path);
/* Returns the kind that a file name promises by its suffix; 0 = unknown. */
file_kind file_kind_named(const char *path);
/* Returns a suffix of a set of kinds, by its index, with repetitions; NULL = there are no more. */
const char *file_kind_ending(file_kind set, int index);
/* Returns the name of one kind: "a recording", ... */
const char *file_kind_name(file_kind kind);

#endif
