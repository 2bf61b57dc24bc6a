/* A file that appears under its name only when it is complete: first written next to it, renamed at the end. A
 * character device (such as /dev/null) is written directly. Files that file_guard.h protects are not replaced, and a
 * signal that ends the process leaves no part. */
#ifndef TRIM3R_TOOLS_WHOLE_FILE_H
#define TRIM3R_TOOLS_WHOLE_FILE_H

#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

typedef struct whole_file {
    FILE *stream;
    const char *path; /* owned by the caller, used until the end */
    char *temporary;  /* NULL: `path` itself is written */
} whole_file;

/* Begins a file. Returns 0, or -1 with "path: why" in error[] (as do the following). After 0, exactly one of commit and
 * abandon must follow. */
int whole_file_begin(whole_file *file, const char *path, char *error, size_t error_bytes);
/* Flushes, closes and renames; on failure removes everything. bytes (may be NULL): the file's length, 0 for a
 * device. */
int whole_file_commit(whole_file *file, uint64_t *bytes, char *error, size_t error_bytes);
void whole_file_abandon(whole_file *file);

#endif
