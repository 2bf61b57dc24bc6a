/* A folder that appears under its name only when it is whole: made next to it first, renamed at the end. An empty one
 * that is there already keeps its place and rights: what belongs into it is made in a hidden folder within. */
#ifndef TRIM3R_TOOLS_WHOLE_FOLDER_H
#define TRIM3R_TOOLS_WHOLE_FOLDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WHOLE_FOLDER_MOST 48 /* files and folders in it */

typedef struct whole_folder {
    const char *path;                  /* the caller's, kept until the end */
    bool within;                       /* it was there */
    char *made[WHOLE_FOLDER_MOST + 1]; /* the folder under its first name, and what it holds, in the order made */
    uint32_t count;                    /* 0: not begun, or ended */
} whole_folder;

/* `path` is nothing yet, or a folder that is empty but for parts that a killed process left. 0, or -1 with "path: why"
 * in error[] (as for the next). Exactly one of commit and abandon must follow a 0. */
int whole_folder_begin(whole_folder *folder, const char *path, char *error, size_t error_bytes);
/* A folder within; those above it come first. */
int whole_folder_make(whole_folder *folder, const char *name, char *error, size_t error_bytes);
/* The path by which to write a file within, valid until the end; NULL with the reason. */
const char *whole_folder_file(whole_folder *folder, const char *name, char *error, size_t error_bytes);
/* On failure nothing is left behind. */
int whole_folder_commit(whole_folder *folder, char *error, size_t error_bytes);
void whole_folder_abandon(whole_folder *folder);

#endif
