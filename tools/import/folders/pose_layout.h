/* SPDX-License-Identifier: Apache-2.0 */
/* File names in folders with a text file for each pose. */
#ifndef TRIM3R_TOOLS_POSE_LAYOUT_H
#define TRIM3R_TOOLS_POSE_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>

/* Lists of names end with NULL; the first that exists counts. Folder ".": DIR itself. */
typedef struct pose_layout {
    const char *const *poses, *const *colours, *const *depths; /* folders */
    const char *pose_ending;
    const char *const *colour_endings, *const *depth_endings;
    const char *const *colour_lenses, *const *depth_lenses; /* files with a camera matrix */
    uint16_t no_depth;     /* a sample of depth pictures that means "none", besides 0; 0: there is no other */
    const char *lens_hint; /* option to suggest if no file has colour's lens */
} pose_layout;

/* Returns NULL if the folder has no such layout. */
const pose_layout *pose_layout_of(const char *directory);
/* Returns the first of the names that exists; NULL: none. */
const char *pose_layout_first(const char *directory, const char *const *names);
/* Returns the path of the file with that stem in one of the folders, on the heap; NULL: there is none. */
char *pose_layout_find(const char *directory, const char *const *folders, const char *stem, const char *const *endings);
/* Whether a name is a pose file's: has the suffix and does not begin with a dot. */
bool pose_layout_is_pose(const pose_layout *layout, const char *name);

#endif
