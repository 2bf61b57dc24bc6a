/* SPDX-License-Identifier: Apache-2.0 */
/* A file that appears under its name only when it is complete: first written next to it, renamed at the end. A
 * character device (such as /dev/null) is written directly. */
#ifndef T3R_PLATFORM_WHOLE_FILE_H
#define T3R_PLATFORM_WHOLE_FILE_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

/* A list of the files that are not complete yet, for a program that removes them when it is ended. */
typedef struct t3r_part_list {
    /* Registers `path` by reference before the part is made. False: the list is full. */
    bool (*add)(char *path);
    void (*forget)(const char *path);
} t3r_part_list;

typedef struct t3r_whole_file {
    FILE *stream;
    const char *path;           /* owned by the caller, used until the end */
    char *temporary;            /* NULL: `path` itself is written */
    const t3r_part_list *parts; /* NULL: none */
} t3r_whole_file;

/* Begins a file; parts may be NULL. Returns 0, or -1 with "path: why" in error[] (as do the following). After 0,
 * exactly one of commit and abandon must follow. */
int t3r_whole_file_begin(t3r_whole_file *file, const char *path, const t3r_part_list *parts, char *error,
                         size_t error_bytes);
/* Flushes, closes and renames; on failure removes everything. bytes (may be NULL): the file's length, 0 for a
 * device. */
int t3r_whole_file_commit(t3r_whole_file *file, uint64_t *bytes, char *error, size_t error_bytes);
void t3r_whole_file_abandon(t3r_whole_file *file);

#endif
