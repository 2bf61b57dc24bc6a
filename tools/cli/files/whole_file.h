/* A file that appears under its name only when it is whole: written next to it first, renamed at the end. A character
 * device (/dev/null, say) is written as it is. What file_guard.h keeps is not replaced, and a signal that ends the
 * process leaves no part. */
#ifndef TRIM3R_TOOLS_WHOLE_FILE_H
#define TRIM3R_TOOLS_WHOLE_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct whole_file {
    FILE *stream;
    const char *path; /* the caller's, kept until the end */
    char *temporary;  /* NULL: `path` itself is written */
} whole_file;

/* 0, or -1 with "path: why" in error[] (as for the next). Exactly one of commit and abandon must follow a 0. */
int whole_file_begin(whole_file *file, const char *path, char *error, size_t error_bytes);
/* Flushes, closes, renames; on failure nothing is left behind. bytes (may be NULL): the file's length, 0 of a device.
 */
int whole_file_commit(whole_file *file, uint64_t *bytes, char *error, size_t error_bytes);
void whole_file_abandon(whole_file *file);

#endif
