/* SPDX-License-Identifier: Apache-2.0 */
/* A context view that comes in strips of rows. */
#include "adding_checks.h"

t3r_status t3r_add_rows(t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, uint32_t row, uint32_t rows,
                        uint32_t depth_row, uint32_t depth_rows)
{
    t3r_frame shown;
    t3r_camera taken;
    t3r_strip strip;
    t3r_strips after;
    T3R_PASS(
        t3r_add_rows_checks(rt, frame, camera, row, rows, depth_row, depth_rows, &shown, &taken, &strip, &after, NULL));
    const uint32_t slot = rt->views; /* none is replaced */
    t3r_begin_view(rt);
    const t3r_status status = t3r_develop_strip(rt, slot, &shown, &strip, &taken);
    if (status == T3R_OK && !strip.ends) {
        rt->strips = after;
    }
    return status != T3R_OK || !strip.ends ? status : t3r_end_view(rt, slot, &taken, frame->depth_unit_q40);
}
