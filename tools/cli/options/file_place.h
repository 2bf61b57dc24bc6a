/* SPDX-License-Identifier: Apache-2.0 */
/* Resolves where a path leads: two paths to one place are one file, whatever the names or links. */
#ifndef TRIM3R_TOOLS_FILE_PLACE_H
#define TRIM3R_TOOLS_FILE_PLACE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

typedef struct file_place {
    mode_t mode; /* st_mode of the existing file; 0 = nothing yet */
    dev_t device, special;
    ino_t inode;       /* of the existing file; else of the nearest existing folder above */
    const char *below; /* the rest of the caller's path from that folder on; "" for an existing file */
    size_t below_bytes;
} file_place;

file_place file_place_of(const char *path);
bool file_place_same(const file_place *a, const file_place *b);
/* Finds the first folder on the path that cannot be entered. Returns the length of the path up to and including that
 * folder, with the errno in *error; 0: all folders exist. The path's last part is not checked. */
size_t file_place_ends(const char *path, int *error);
/* Whether the path is a dangling symbolic link. */
bool file_place_dangles(const char *path);
/* Whether the path lies in that folder or below it. */
bool file_place_beneath(const char *path, const file_place *folder);

#endif
