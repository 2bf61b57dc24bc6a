/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/transform_tree.h"

#include <stdlib.h>
#include <string.h>

#include "host/grow.h"
#include "mcap/reader_limits.h"

#define SLOTS (2u * T3R_LIMIT_TRANSFORM_FRAMES) /* a power of two; at least half stay free */

t3r_text transform_tree_name(t3r_text name)
{
    return name.count > 0 && name.chars[0] == '/' ? (t3r_text){name.chars + 1, name.count - 1} : name;
}

/* Returns the slot of that name, or the free one for it (FNV-1a). */
static uint32_t *slot_of(const transform_tree *tree, t3r_text name)
{
    uint32_t hash = 2166136261u;
    for (size_t i = 0; i < name.count; i++) {
        hash = (hash ^ (uint8_t)name.chars[i]) * 16777619u;
    }
    uint32_t at = hash % SLOTS;
    while (tree->slots[at] != 0 && !t3r_text_is(name, tree->frames[tree->slots[at] - 1].name)) {
        at = (at + 1) % SLOTS;
    }
    return &tree->slots[at];
}

/* Returns the frame of that name, made if necessary; TRANSFORM_NO_FRAME with a reason in *wrong. */
static uint32_t frame_of(transform_tree *tree, t3r_text name, const char **wrong)
{
    name = transform_tree_name(name);
    tree->slots = tree->slots != NULL ? tree->slots : calloc(SLOTS, sizeof *tree->slots);
    if (tree->slots == NULL || name.count == 0 || memchr(name.chars, 0, name.count) != NULL) {
        *wrong = tree->slots == NULL ? "out of memory" : "a frame has no name";
        return TRANSFORM_NO_FRAME;
    }
    uint32_t *slot = slot_of(tree, name);
    if (*slot != 0) {
        return *slot - 1;
    }
    if (tree->count == T3R_LIMIT_TRANSFORM_FRAMES) {
        *wrong = T3R_LIMIT_TEXT("there are more than ", T3R_LIMIT_TRANSFORM_FRAMES, " frames");
        return TRANSFORM_NO_FRAME;
    }
    transform_frame *grown = t3r_grow(tree->frames, tree->count, &tree->capacity, sizeof *grown);
    tree->frames = grown != NULL ? grown : tree->frames;
    char *copy = grown != NULL ? malloc(name.count + 1) : NULL;
    if (copy == NULL) {
        *wrong = "out of memory";
        return TRANSFORM_NO_FRAME;
    }
    memcpy(copy, name.chars, name.count);
    copy[name.count] = '\0';
    tree->frames[tree->count] = (transform_frame){.name = copy, .parent = TRANSFORM_NO_FRAME};
    *slot = ++tree->count;
    return tree->count - 1;
}

const char *transform_tree_add(transform_tree *tree, t3r_text parent, t3r_text child, bool standing, int64_t stamp_ns,
                               const rigid *transform)
{
    const char *wrong = NULL;
    uint32_t above = frame_of(tree, parent, &wrong);
    uint32_t frame = above != TRANSFORM_NO_FRAME ? frame_of(tree, child, &wrong) : above;
    if (wrong != NULL) {
        return wrong;
    }
    transform_frame *f = &tree->frames[frame];
    if (f->parent != TRANSFORM_NO_FRAME && f->parent != above) {
        tree->refused_frame = tree->refused == 0 ? frame : tree->refused_frame;
        tree->refused_parent = tree->refused == 0 ? above : tree->refused_parent;
        tree->refused++;
        return NULL;
    }
    f->parent = above;
    f->track.standing = f->track.standing || standing;
    return pose_track_add(&f->track, stamp_ns, transform) ? NULL : "out of memory";
}

const char *transform_tree_finish(transform_tree *tree)
{
    for (uint32_t i = 0; i < tree->count; i++) {
        uint32_t steps = 0;
        for (uint32_t at = i; at != TRANSFORM_NO_FRAME; at = tree->frames[at].parent) {
            if (steps++ > T3R_LIMIT_TRANSFORM_DEPTH) {
                return T3R_LIMIT_TEXT("a frame has more than ", T3R_LIMIT_TRANSFORM_DEPTH,
                                      " above it, or is above itself");
            }
        }
        pose_track_sort(&tree->frames[i].track);
    }
    return NULL;
}

uint32_t transform_tree_find(const transform_tree *tree, t3r_text name)
{
    name = transform_tree_name(name);
    return tree->slots == NULL ? TRANSFORM_NO_FRAME : *slot_of(tree, name) - 1; /* 0 - 1: no frame */
}

uint32_t transform_tree_root(const transform_tree *tree, uint32_t frame)
{
    while (tree->frames[frame].parent != TRANSFORM_NO_FRAME) {
        frame = tree->frames[frame].parent;
    }
    return frame;
}

bool transform_tree_moves(const transform_tree *tree, uint32_t frame)
{
    bool moves = false;
    for (; tree->frames[frame].parent != TRANSFORM_NO_FRAME; frame = tree->frames[frame].parent) {
        moves = moves || !tree->frames[frame].track.standing;
    }
    return moves;
}

static uint32_t depth_of(const transform_tree *tree, uint32_t frame)
{
    uint32_t depth = 0;
    for (; tree->frames[frame].parent != TRANSFORM_NO_FRAME; frame = tree->frames[frame].parent) {
        depth++;
    }
    return depth;
}

/* Returns the lowest common ancestor of both frames, which may be one of them; TRANSFORM_NO_FRAME if their roots
 * differ. */
static uint32_t common_frame(const transform_tree *tree, uint32_t a, uint32_t b)
{
    uint32_t depth_a = depth_of(tree, a), depth_b = depth_of(tree, b);
    while (a != b && (depth_a > 0 || depth_b > 0)) {
        if (depth_a >= depth_b) {
            a = tree->frames[a].parent;
            depth_a--;
        } else {
            b = tree->frames[b].parent;
            depth_b--;
        }
    }
    return a == b ? a : TRANSFORM_NO_FRAME;
}

/* Composes the transform from `frame` to its ancestor `top`. */
static bool climb(const transform_tree *tree, uint32_t top, uint32_t frame, int64_t stamp_ns, int64_t near_ns,
                  rigid *out)
{
    *out = rigid_identity;
    for (; frame != top; frame = tree->frames[frame].parent) {
        rigid step;
        if (!pose_track_at(&tree->frames[frame].track, stamp_ns, near_ns, &step)) {
            return false;
        }
        *out = rigid_compose(&step, out);
    }
    return true;
}

bool transform_tree_lookup(const transform_tree *tree, uint32_t to, uint32_t frame, int64_t stamp_ns, int64_t near_ns,
                           rigid *out)
{
    if (to == TRANSFORM_NO_FRAME || frame == TRANSFORM_NO_FRAME) {
        return false;
    }
    uint32_t top = common_frame(tree, to, frame);
    rigid up, down;
    if (top == TRANSFORM_NO_FRAME || !climb(tree, top, frame, stamp_ns, near_ns, &up) ||
        !climb(tree, top, to, stamp_ns, near_ns, &down)) {
        return false;
    }
    rigid back = rigid_inverse(&down);
    *out = to == top ? up : rigid_compose(&back, &up);
    return true;
}

void transform_tree_free(transform_tree *tree)
{
    for (uint32_t i = 0; i < tree->count; i++) {
        free(tree->frames[i].name);
        pose_track_free(&tree->frames[i].track);
    }
    free(tree->frames);
    free(tree->slots);
    *tree = (transform_tree){0};
}
