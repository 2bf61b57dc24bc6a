/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of calls that take a frame: their arguments, the state, the frame with its camera. */
#ifndef T3R_ADDING_CHECKS_H
#define T3R_ADDING_CHECKS_H

#include <stdbool.h>

#include "adding.h"
#include "core/features.h"
#include "core/hash.h"
#include "image/develop.h"
#include "state/state.h"

/* Checks a frame with its camera, for a sentence if one is wanted. */
#define T3R_CHECK_FRAME(rt, frame, camera, resized, fault)                                                             \
    T3R_PASS((fault) == NULL ? t3r_frame_check((rt), (frame), (camera), (resized))                                     \
                             : t3r_frame_fault((rt), (frame), (camera), (resized), (fault)))

T3R_CHECKS t3r_taken_checks(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, t3r_fault *fault)
{
    T3R_PASS(t3r_runtime_checks(rt, fault));
    T3R_MISUSE(fault, frame != NULL, T3R_ERR_ARGUMENT, "frame is NULL");
    T3R_MISUSE(fault, camera != NULL, T3R_ERR_ARGUMENT, "camera is NULL");
    return T3R_OK;
}

/* Returns the sentence for a state in which t3r_takes_view() is false. */
static inline const char *t3r_no_view_text(const t3r_runtime *rt)
{
    if (t3r_is_stream(&rt->config)) {
        return "this runtime is a stream's: t3r_stream_keyframe() takes its frames";
    }
    if (rt->config.views == 0) {
        return "config.views is 0: this runtime draws scenes and takes no views";
    }
    return rt->has_scene ? "there is a scene already: t3r_reset() comes before the next view, unless config.warm is set"
                         : "there are # views, the most by config.views: t3r_reconstruct() is next, or t3r_reset()";
}

#define T3R_NO_DEPTH_TEXT "frame.depth is NULL: unless config.depth is T3R_DEPTH_STEREO each frame has a depth plane"

/* *shown becomes the frame as the image stage reads it, *resized its camera at the working size. */
T3R_CHECKS t3r_add_view_checks(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                               t3r_frame *shown, t3r_camera *resized, t3r_fault *fault)
{
    T3R_PASS(t3r_taken_checks(rt, frame, camera, fault));
    T3R_MISUSE(fault, t3r_takes_view(rt), T3R_ERR_STATE, t3r_no_view_text(rt), rt->views);
    *shown = *frame;
    if (t3r_is_by_stereo(&rt->config)) {
        shown->depth = NULL;
    } else {
        T3R_CHECK(fault, frame->depth != NULL, T3R_ERR_NO_DEPTH, T3R_NO_DEPTH_TEXT);
    }
    T3R_CHECK_FRAME(rt, shown, camera, resized, fault);
    return T3R_OK;
}

/* --- strips --------------------------------------------------------------------------------------------------- */

/* Everything that must stay the same from strip to strip: the frame except its planes, and the camera. */
typedef struct t3r_shown_frame {
    t3r_camera camera;
    uint64_t depth_unit_q40;
    uint32_t format, width, height, depth_width, depth_height;
    uint32_t zero; /* in place of padding */
} t3r_shown_frame;

_Static_assert(sizeof(t3r_camera) == 16 * sizeof(int32_t) + 3 * sizeof(int64_t) &&
                   sizeof(t3r_shown_frame) == sizeof(t3r_camera) + 4 * sizeof(uint64_t),
               "no padding, whose bytes may be any");

/* Hashes the bytes as stored: the digest never leaves the runtime. */
static inline __attribute__((always_inline)) uint64_t t3r_digest_of(const t3r_frame *frame, const t3r_camera *camera)
{
    const t3r_shown_frame shown = {*camera,       frame->depth_unit_q40, frame->format,       frame->width,
                                   frame->height, frame->depth_width,    frame->depth_height, 0};
    return t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)&shown, sizeof shown);
}

/* Whether the rows lie within `height`, and are even with NV12, whose chroma has one row for two. */
T3R_CONDITION t3r_are_rows(uint32_t row, uint32_t rows, uint32_t height, uint32_t step)
{
    return row <= height && rows <= height - row && (row | rows) % step == 0; /* a step is 1 or 2 */
}

/* *shown and *resized are as for a whole view; *strip becomes the strip, and *after the rows received with it. */
T3R_CHECKS t3r_add_rows_checks(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t row,
                               uint32_t rows, uint32_t depth_row, uint32_t depth_rows, t3r_frame *shown,
                               t3r_camera *resized, t3r_strip *strip, t3r_strips *after, t3r_fault *fault)
{
    T3R_PASS(t3r_taken_checks(rt, frame, camera, fault));
    T3R_MISUSE(fault, t3r_takes_view(rt), T3R_ERR_STATE, t3r_no_view_text(rt), rt->views);
    T3R_MISUSE(fault, t3r_slot_of_next(rt) == rt->views, T3R_ERR_STATE,
               "there are # views, the most by config.views, and strips replace none: t3r_add_view() does", rt->views);
    *shown = *frame;
    if (t3r_is_by_stereo(&rt->config)) {
        shown->depth = NULL;
        depth_row = depth_rows = 0;
    } else {
        T3R_CHECK(fault, frame->depth != NULL, T3R_ERR_NO_DEPTH, T3R_NO_DEPTH_TEXT);
    }
    const uint32_t depth_height = shown->depth == NULL ? 0 : shown->depth_height;
    T3R_CHECK_FRAME(rt, shown, camera, resized, fault);
    T3R_CHECK(fault, t3r_are_rows(row, rows, shown->height, shown->format == T3R_PIXEL_NV12 ? 2 : 1), T3R_ERR_FRAME,
              t3r_are_rows(row, rows, shown->height, 1)
                  ? "row is # and rows is #: T3R_PIXEL_NV12 comes in pairs of rows"
                  : "row is # and rows is #, past the end: frame.height is #",
              row, rows, shown->height);
    T3R_CHECK(fault, t3r_are_rows(depth_row, depth_rows, depth_height, 1), T3R_ERR_FRAME,
              "depth_row is # and depth_rows is #, past the end: frame.depth_height is #", depth_row, depth_rows,
              depth_height);

    const uint64_t digest = t3r_digest_of(shown, camera);
    const bool begins = row == 0 && depth_row == 0 && (rows > 0 || rt->strips.rows == 0);
    const t3r_strips none = {.digest = digest};
    const t3r_strips before = begins ? none : rt->strips;
    T3R_MISUSE(fault, row == before.rows, T3R_ERR_STATE, "row is #, out of order: row # is next", row, before.rows);
    T3R_MISUSE(fault, depth_row == before.depth_rows, T3R_ERR_STATE,
               "depth_row is #, out of order: row # of depth is next", depth_row, before.depth_rows);
    T3R_MISUSE(fault, digest == before.digest, T3R_ERR_STATE,
               "frame or camera differ from those of the strip before: only planes and rows may change");
    *after = (t3r_strips){digest, row + rows, depth_row + depth_rows};
    *strip = (t3r_strip){.row = row,
                         .rows = rows,
                         .depth_row = depth_row,
                         .depth_rows = depth_rows,
                         .begins = begins,
                         .ends = after->rows == shown->height && after->depth_rows == depth_height};
    return T3R_OK;
}

/* --- the image stage alone ------------------------------------------------------------------------------------ */

T3R_CHECKS t3r_develop_call_checks(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera,
                                   const uint8_t *rgb_out, const t3r_camera *undistorted, t3r_camera *resized,
                                   t3r_fault *fault)
{
    T3R_PASS(t3r_taken_checks(rt, frame, camera, fault));
    T3R_MISUSE(fault, rgb_out != NULL, T3R_ERR_ARGUMENT, "rgb_out is NULL");
    T3R_MISUSE(fault, undistorted != NULL, T3R_ERR_ARGUMENT, "undistorted is NULL");
    T3R_MISUSE(fault, rt->config.views > 0, T3R_ERR_STATE, "config.views is 0: this runtime has no planes to work in");
    T3R_MISUSE(fault, rt->views == 0 && !rt->has_scene, T3R_ERR_STATE,
               "there are views or a scene, and t3r_develop() works in their memory: call t3r_reset() first");
    T3R_CHECK_FRAME(rt, frame, camera, resized, fault);
    return T3R_OK;
}

#endif
