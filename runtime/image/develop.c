#include "develop.h"

#include "core/camera.h"
#include "core/cut.h"
#include "depth/depth.h"
#include "image.h"
#include "state/state.h"
#include "undistort.h"

/* A frame on its way into a view's planes. */
typedef struct develop_job {
    const t3r_runtime *rt;
    const t3r_frame *frame;
    const t3r_view *view;
    const int32_t *grid; /* NULL: nothing to undistort */
    uint8_t *colour[3];  /* resized: the view's own planes, or those that are undistorted into them */
    uint16_t *depth;
    uint8_t *work; /* T3R_IMAGE_ROW_BYTES_ a worker */
} develop_job;

static void resize_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    const develop_job *job = context;
    const uint32_t width = job->view->width, height = job->view->height;
    t3r_image_colour(&job->rt->kernels, job->frame, width, height, begin, end, job->colour,
                     job->work + worker * T3R_IMAGE_ROW_BYTES_(width));
    t3r_image_depth(job->frame, width, height, begin, end, job->depth);
}

static void undistort_rows(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const develop_job *job = context;
    const uint32_t width = job->view->width, height = job->view->height;
    t3r_undistort_colour(job->grid, width, height, begin, end, (const uint8_t *const *)job->colour, job->view->colour);
    t3r_undistort_depth(job->grid, width, height, begin, end, job->depth, job->view->depth);
}

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
    t3r_view planes = t3r_view_of(rt, index), *view = &planes;

    t3r_cut cut =
        t3r_cut_of(t3r_buffer_at(rt, T3R_BUFFER_IMAGE_WORK), T3R_IMAGE_WORK_BYTES_(width, height, rt->config.workers));
    const size_t pixels = T3R_PIXELS_(width, height);
    develop_job job = {
        .rt = rt, .frame = frame, .view = view, .colour = {view->colour[0], view->colour[1], view->colour[2]}};
    int32_t *grid = t3r_take(&cut, T3R_GRID_NODES_(width, height) * 8);
    job.work = t3r_take(&cut, rt->config.workers * T3R_IMAGE_ROW_BYTES_(width));
    job.depth = view->depth;
    const t3r_workers workers = t3r_workers_of(rt);
    if (resized.distortion != T3R_DISTORTION_NONE) {
        status = t3r_undistort_grid(&resized, width, height, grid);
        if (status != T3R_OK) {
            return status;
        }
        job.grid = grid;
        job.depth = t3r_take(&cut, pixels * sizeof *job.depth);
        uint8_t *colour = t3r_take(&cut, 3 * pixels);
        for (int c = 0; c < 3; c++) {
            job.colour[c] = colour + (size_t)c * pixels;
        }
    }
    t3r_run_rows(&workers, height, resize_rows, &job);
    if (job.grid != NULL) {
        t3r_run_rows(&workers, height, undistort_rows, &job);
    }
    t3r_depth_validity(view);
    resized.distortion = T3R_DISTORTION_NONE;
    for (int i = 0; i < 5; i++) {
        resized.distortion_q24[i] = 0;
    }
    *undistorted = resized;
    return T3R_OK;
}
