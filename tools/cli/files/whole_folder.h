/* A folder that appears under its name only when it is complete: made next to it first, renamed at the end. An existing
 * empty folder keeps its place and rights: its contents are made in a hidden folder inside. */
#ifndef TRIM3R_TOOLS_WHOLE_FOLDER_H
#define TRIM3R_TOOLS_WHOLE_FOLDER_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#define WHOLE_FOLDER_MOST 48 /* files and folders in it */

typedef struct whole_folder {
    const char *path;                  /* owned by the caller, used until the end */
    bool within;                       /* the folder existed */
    char *made[WHOLE_FOLDER_MOST + 1]; /* the folder under its temporary name, and its contents, in the order made */
    uint32_t count;                    /* 0: not begun, or ended */
} whole_folder;

/* Begins a folder. `path` must not exist, or be a folder that is empty except for parts left by a killed process.
 * Returns 0, or -1 with "path: why" in error[] (as do the following). After 0, exactly one of commit and abandon must
 * follow. */
int whole_folder_begin(whole_folder *folder, const char *path, char *error, size_t error_bytes);
/* Makes a folder inside; parents must be made first. */
int whole_folder_make(whole_folder *folder, const char *name, char *error, size_t error_bytes);
/* Returns the path for writing a file inside, valid until the end; NULL with the reason. */
const char *whole_folder_file(whole_folder *folder, const char *name, char *error, size_t error_bytes);
/* Moves the folder to its name; on failure removes everything. */
int whole_folder_commit(whole_folder *folder, char *error, size_t error_bytes);
void whole_folder_abandon(whole_folder *folder);

#endif
