#include "develop.h"

#include "core/camera.h"
#include "depth/depth.h"
#include "image.h"
#include "state/state.h"
#include "undistort.h"

t3r_status t3r_develop_view(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_camera *camera,
                            t3r_camera *undistorted)
{
    t3r_status status = t3r_image_check(frame);
    if (status == T3R_OK) {
        status = t3r_camera_check(camera);
    }
    if (status != T3R_OK) {
        return status;
    }
    uint32_t width = rt->config.width, height = rt->config.height;
    t3r_camera resized = t3r_camera_resized(camera, frame->width, frame->height, width, height);
    status = t3r_camera_check(&resized);
    if (status != T3R_OK) {
        return status;
    }
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(rt, views);
    t3r_view *view = &views[index];

    /* The work buffer: grid, resize rows, a depth plane, three colour planes (trim3r_arena.h). */
    size_t pixels = T3R_PIXELS_(width, height);
    uint8_t *work = t3r_buffer_at(rt, T3R_BUFFER_IMAGE_WORK);
    int32_t *grid = (int32_t *)(void *)work;
    uint8_t *rows = work + T3R_GRID_NODES_(width, height) * 8;
    uint16_t *depth = (uint16_t *)(void *)(rows + t3r_image_work_bytes(width));
    uint8_t *colour = (uint8_t *)(depth + pixels);
    uint8_t *const raw[3] = {colour, colour + pixels, colour + 2 * pixels};

    if (resized.distortion == T3R_DISTORTION_NONE) {
        t3r_image_colour(&rt->kernels, frame, width, height, view->colour, rows);
        t3r_image_depth(frame, width, height, view->depth);
    } else {
        status = t3r_undistort_grid(&resized, width, height, grid);
        if (status != T3R_OK) {
            return status;
        }
        t3r_image_colour(&rt->kernels, frame, width, height, raw, rows);
        t3r_image_depth(frame, width, height, depth);
        t3r_undistort_colour(grid, width, height, (const uint8_t *const *)raw, view->colour);
        t3r_undistort_depth(grid, width, height, depth, view->depth);
    }
    t3r_depth_validity(view);
    resized.distortion = T3R_DISTORTION_NONE;
    for (int i = 0; i < 5; i++) {
        resized.distortion_q24[i] = 0;
    }
    *undistorted = resized;
    return T3R_OK;
}
