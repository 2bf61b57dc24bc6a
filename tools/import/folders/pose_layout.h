/* How folders with a text for each pose name their files. */
#ifndef TRIM3R_TOOLS_POSE_LAYOUT_H
#define TRIM3R_TOOLS_POSE_LAYOUT_H

#include <stdbool.h>
#include <stdint.h>

/* Lists of names end with NULL; of several the first that is there counts. Folder ".": DIR itself. */
typedef struct pose_layout {
    const char *const *poses, *const *colours, *const *depths; /* folders */
    const char *pose_ending;
    const char *const *colour_endings, *const *depth_endings;
    const char *const *colour_lenses, *const *depth_lenses; /* files with a camera matrix */
    uint16_t no_depth;     /* a sample of depth pictures that stands for none, as 0 does in all; 0: there is no other */
    const char *lens_hint; /* what to give where no file has colour's lens */
} pose_layout;

/* NULL: none. */
const pose_layout *pose_layout_of(const char *directory);
/* The first of the names that is there; NULL: none. */
const char *pose_layout_first(const char *directory, const char *const *names);
/* The file of that name in one of the folders, on the heap; NULL: there is none. */
char *pose_layout_find(const char *directory, const char *const *folders, const char *stem, const char *const *endings);
/* Whether a name is that of a pose: ends so, and begins with something else than a dot. */
bool pose_layout_is_pose(const pose_layout *layout, const char *name);

#endif
