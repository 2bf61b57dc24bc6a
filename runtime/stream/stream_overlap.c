/* SPDX-License-Identifier: Apache-2.0 */
#include "stream_overlap.h"

#include "core/bits.h"
#include "core/camera.h"
#include "core/fixed.h"
#include "pointmap/reproject.h"
#include "state/state.h"

#define STEP 2 /* pixels */
#define GRID 8 /* cells along each side of the picture */

/* Returns the bit of a pixel's cell. */
static uint64_t cell_of(const t3r_view *view, size_t pixel)
{
    uint32_t x = (uint32_t)(pixel % view->width), y = (uint32_t)(pixel / view->width);
    return UINT64_C(1) << (y * GRID / view->height * GRID + x * GRID / view->width);
}

static uint32_t count_cells(uint64_t cells)
{
    return t3r_ones((uint32_t)cells) + t3r_ones((uint32_t)(cells >> 32));
}

t3r_status t3r_overlap_with_newest(const t3r_runtime *rt, const t3r_camera *camera, uint32_t width, uint32_t height,
                                   uint32_t *overlap_q8)
{
    const t3r_view view = t3r_view_of(rt, (rt->next_slot + rt->config.views - 1) % rt->config.views), *newest = &view;
    const t3r_pointmap map = t3r_pointmap_of(newest, rt->frame.exponent);
    const t3r_camera resized = t3r_camera_resized(camera, width, height, newest->width, newest->height);
    t3r_view there = {
        .width = newest->width,
        .height = newest->height,
        .fx_q16 = resized.fx_q16,
        .fy_q16 = resized.fy_q16,
        .cx_q16 = resized.cx_q16,
        .cy_q16 = resized.cy_q16,
    };
    t3r_status status = t3r_camera_check(&resized, newest->width, newest->height);
    if (status == T3R_OK) {
        status = t3r_pose_in_scene(camera, &rt->frame, &there.pose);
    }
    if (status != T3R_OK) {
        return status;
    }
    uint32_t points = 0, shown = 0;
    uint64_t own_cells = 0, cells = 0;
    for (uint32_t y = 0; y < newest->height; y += STEP) {
        for (uint32_t x = 0; x < newest->width; x += STEP) {
            int32_t point[3];
            t3r_projected_pixel projected;
            if (!t3r_point(&map, x, y, point)) {
                continue;
            }
            points++;
            own_cells |= cell_of(newest, (size_t)y * newest->width + x);
            if (t3r_project_to_pixel(&there, point, &projected)) {
                shown++;
                cells |= cell_of(&there, projected.pixel);
            }
        }
    }
    uint32_t of_points = points == 0 ? 0 : shown * 256 / points; /* below 2^22 x 2^8 */
    uint32_t of_cells = points == 0 ? 0 : count_cells(cells) * 256 / count_cells(own_cells);
    *overlap_q8 = T3R_MIN(of_points, of_cells);
    return T3R_OK;
}
