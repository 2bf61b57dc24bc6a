/* SPDX-License-Identifier: Apache-2.0 */
/* A context view that comes in strips of rows. */
#include "adding.h"
#include "core/features.h"
#include "core/hash.h"
#include "image/develop.h"
#include "state/state.h"

/* Everything that must stay the same from strip to strip: the frame except its planes, and the camera. */
typedef struct shown_frame {
    t3r_camera camera;
    uint64_t depth_unit_q40;
    uint32_t format, width, height, depth_width, depth_height;
    uint32_t zero; /* in place of padding */
} shown_frame;

_Static_assert(sizeof(t3r_camera) == 16 * sizeof(int32_t) + 3 * sizeof(int64_t) &&
                   sizeof(shown_frame) == sizeof(t3r_camera) + 4 * sizeof(uint64_t),
               "no padding, whose bytes may be any");

/* Hashes the bytes as stored: the digest never leaves the runtime. */
static uint64_t digest_of(const t3r_frame *frame, const t3r_camera *camera)
{
    const shown_frame shown = {*camera,       frame->depth_unit_q40, frame->format,       frame->width,
                               frame->height, frame->depth_width,    frame->depth_height, 0};
    return t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)&shown, sizeof shown);
}

/* Whether the rows lie within `height`, and are even with NV12, whose chroma has one row for two. */
static bool are_rows(uint32_t row, uint32_t rows, uint32_t height, uint32_t step)
{
    return row <= height && rows <= height - row && (row | rows) % step == 0; /* a step is 1 or 2 */
}

t3r_status t3r_add_rows(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t row, uint32_t rows,
                        uint32_t depth_row, uint32_t depth_rows)
{
    T3R_REFUSE_UNLESS(rt != NULL && frame != NULL && camera != NULL, T3R_ERR_ARGUMENT);
    const uint32_t slot = t3r_slot_of_next(rt);
    T3R_REFUSE_UNLESS(t3r_takes_view(rt) && slot == rt->views, T3R_ERR_STATE);
    t3r_frame shown = *frame;
    if (t3r_is_by_stereo(&rt->config)) {
        shown.depth = NULL;
        depth_row = depth_rows = 0;
    } else if (frame->depth == NULL) {
        return T3R_ERR_NO_DEPTH;
    }
    const uint32_t depth_height = shown.depth == NULL ? 0 : shown.depth_height;
    t3r_camera taken;
    t3r_status status = t3r_frame_check(rt, &shown, camera, &taken);
    if (status != T3R_OK) {
        return status;
    }
    if (!are_rows(row, rows, shown.height, shown.format == T3R_PIXEL_NV12 ? 2 : 1) ||
        !are_rows(depth_row, depth_rows, depth_height, 1)) {
        return T3R_ERR_FRAME;
    }
    const uint64_t digest = digest_of(&shown, camera);
    const bool begins = row == 0 && depth_row == 0 && (rows > 0 || rt->strips.rows == 0);
    const t3r_strips none = {.digest = digest};
    const t3r_strips before = begins ? none : rt->strips;
    T3R_REFUSE_UNLESS(row == before.rows && depth_row == before.depth_rows && digest == before.digest, T3R_ERR_STATE);

    const t3r_strips after = {digest, row + rows, depth_row + depth_rows};
    const t3r_strip strip = {.row = row,
                             .rows = rows,
                             .depth_row = depth_row,
                             .depth_rows = depth_rows,
                             .begins = begins,
                             .ends = after.rows == shown.height && after.depth_rows == depth_height};
    t3r_begin_view(rt);
    status = t3r_develop_strip(rt, slot, &shown, &strip, &taken);
    if (status == T3R_OK && !strip.ends) {
        rt->strips = after;
    }
    return status != T3R_OK || !strip.ends ? status : t3r_end_view(rt, slot, &taken, frame->depth_unit_q40);
}
