/* Kinds of files that the commands write, as their first bytes show them. */
#ifndef TRIM3R_TOOLS_FILE_KIND_H
#define TRIM3R_TOOLS_FILE_KIND_H

/* A set of kinds; a bit each. */
typedef enum file_kind {
    FILE_RECORDING = 1,
    FILE_SCENE = 2,
    FILE_PICTURE = 4, /* PNG */
    FILE_SVG = 8,
    FILE_PAGE = 16, /* HTML */
    FILE_TABLE = 32,
    FILE_WEIGHTS = 64,
    FILE_SOURCE = 128, /* a head as a C array */
    FILE_OTHER = 256,  /* none of these */
} file_kind;

#define FILE_KINDS 9

/* Of what is there; 0 = nothing, or an empty file: it is of any kind. */
file_kind file_kind_of(const char *path);
/* What a file of that name is to be, by its ending; 0 = not known. */
file_kind file_kind_named(const char *path);
/* "a recording", ... of one kind. */
const char *file_kind_name(file_kind kind);

#endif
