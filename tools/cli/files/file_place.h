/* Where a path leads: two paths of one place are one file, by whatever name or link. */
#ifndef TRIM3R_TOOLS_FILE_PLACE_H
#define TRIM3R_TOOLS_FILE_PLACE_H

#include <stdbool.h>
#include <stddef.h>
#include <sys/types.h>

typedef struct file_place {
    mode_t mode; /* of what is there, as stat() has it; 0 = nothing yet */
    dev_t device, special;
    ino_t inode;       /* of what is there; else of the nearest folder above that is */
    const char *below; /* the caller's path from that folder on; "" of what is there */
    size_t below_bytes;
} file_place;

file_place file_place_of(const char *path);
bool file_place_same(const file_place *a, const file_place *b);
/* The folder among those that the path leads through at which it ends: the number of the path's bytes that name it, and
 * why in *error, as errno has it. 0: all are there. Of a path's last part nothing is asked. */
size_t file_place_ends(const char *path, int *error);
/* Whether the path is a symbolic link to nothing. */
bool file_place_dangles(const char *path);
/* Whether the path's folder is that folder or lies beneath it. */
bool file_place_beneath(const char *path, const file_place *folder);

#endif
