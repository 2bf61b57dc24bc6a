/* The frames of /tf and /tf_static: each has a parent, and its place in it over time. */
#ifndef TRIM3R_TOOLS_TRANSFORM_TREE_H
#define TRIM3R_TOOLS_TRANSFORM_TREE_H

#include <stddef.h>
#include <stdint.h>

#include "import/poses/pose_track.h"
#include "host/text.h"

#define TRANSFORM_NO_FRAME UINT32_MAX

typedef struct transform_frame {
    char *name;
    uint32_t parent;  /* TRANSFORM_NO_FRAME: a root */
    pose_track track; /* in its parent */
} transform_frame;

typedef struct transform_tree {
    transform_frame *frames;
    uint32_t count;
    size_t capacity;
    uint32_t *slots;  /* the frames by their names' hashes: index + 1, 0 = free */
    uint64_t refused; /* transforms of a frame that has another parent already */
} transform_tree;

/* A frame's name without the leading slash that older writers put before it. */
t3r_text transform_tree_name(t3r_text name);

/* Start with zeros. A transform of `child` in `parent`. NULL, or what is
 * wrong. */
const char *transform_tree_add(transform_tree *tree, t3r_text parent, t3r_text child, bool standing, int64_t stamp_ns,
                               const rigid *transform);
/* Once, when all are added. NULL, or what is wrong: a frame that is above itself. */
const char *transform_tree_finish(transform_tree *tree);
/* TRANSFORM_NO_FRAME where there is none of that name. */
uint32_t transform_tree_find(const transform_tree *tree, t3r_text name);
uint32_t transform_tree_root(const transform_tree *tree, uint32_t frame);
/* Whether anything between a frame and its root changes over time. */
bool transform_tree_moves(const transform_tree *tree, uint32_t frame);
/* From `frame` to `to` at that time; false where they are not connected then. */
bool transform_tree_lookup(const transform_tree *tree, uint32_t to, uint32_t frame, int64_t stamp_ns, int64_t near_ns,
                           rigid *out);
void transform_tree_free(transform_tree *tree);

#endif
