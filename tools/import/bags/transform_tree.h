/* SPDX-License-Identifier: Apache-2.0 */
/* The frames of /tf and /tf_static: each has a parent, and a pose in its parent over time. */
#ifndef TRIM3R_TOOLS_TRANSFORM_TREE_H
#define TRIM3R_TOOLS_TRANSFORM_TREE_H

#include <stddef.h>
#include <stdint.h>

#include "host/text.h"
#include "import/poses/pose_track.h"

#define TRANSFORM_NO_FRAME UINT32_MAX

typedef struct transform_frame {
    char *name;
    uint32_t parent;  /* TRANSFORM_NO_FRAME: a root */
    pose_track track; /* pose in the parent */
} transform_frame;

typedef struct transform_tree {
    transform_frame *frames;
    uint32_t count;
    size_t capacity;
    uint32_t *slots;                        /* hash table of the frames' names: index + 1, 0 = free */
    uint64_t refused;                       /* transforms of frames that already have another parent */
    uint32_t refused_frame, refused_parent; /* of the first */
} transform_tree;

/* Returns a frame's name without the leading slash that older writers add. */
t3r_text transform_tree_name(t3r_text name);

/* Adds a transform of `child` in `parent`; the tree starts as zeros. Returns NULL, or what is wrong. */
const char *transform_tree_add(transform_tree *tree, t3r_text parent, t3r_text child, bool standing, int64_t stamp_ns,
                               const rigid *transform);
/* Finishes the tree; call once, when all transforms are added. Returns NULL, or what is wrong: a frame above itself. */
const char *transform_tree_finish(transform_tree *tree);
/* Returns TRANSFORM_NO_FRAME if no frame has that name. */
uint32_t transform_tree_find(const transform_tree *tree, t3r_text name);
uint32_t transform_tree_root(const transform_tree *tree, uint32_t frame);
/* Whether any transform between a frame and its root changes over time. */
bool transform_tree_moves(const transform_tree *tree, uint32_t frame);
/* Looks up the transform from `frame` to `to` at that time; false if they are not connected then. */
bool transform_tree_lookup(const transform_tree *tree, uint32_t to, uint32_t frame, int64_t stamp_ns, int64_t near_ns,
                           rigid *out);
void transform_tree_free(transform_tree *tree);

#endif
