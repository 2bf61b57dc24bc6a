/* SPDX-License-Identifier: Apache-2.0 */
#include "develop.h"

#include "core/cut.h"
#include "depth/depth.h"
#include "develop_checks.h"
#include "image.h"
#include "state/state.h"
#include "undistort.h"

/* State of converting a frame into a view's planes. */
typedef struct develop_job {
    const t3r_runtime *rt;
    const t3r_frame *frame;
    t3r_view *view;
    int32_t *grid;      /* NULL: no undistortion */
    uint8_t *colour[3]; /* resized planes: the view's own, or the input of undistortion */
    uint16_t *depth;
    uint8_t *work; /* T3R_IMAGE_ROW_BYTES_ for each worker */
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

t3r_status t3r_frame_check(const t3r_runtime *rt, const t3r_frame *frame, const t3r_camera *camera, t3r_camera *resized)
{
    return t3r_develop_checks(rt, frame, camera, resized, NULL);
}

/* Assigns the parts of the work memory. */
static develop_job job_of(const t3r_runtime *rt, const t3r_frame *frame, t3r_view *view, const t3r_camera *resized)
{
    const uint32_t width = rt->config.width, height = rt->config.height;
    t3r_cut cut =
        t3r_cut_of(t3r_buffer_at(rt, T3R_BUFFER_IMAGE_WORK), T3R_IMAGE_WORK_BYTES_(width, height, rt->config.workers));
    const size_t pixels = T3R_PIXELS_(width, height);
    develop_job job = {
        .rt = rt, .frame = frame, .view = view, .colour = {view->colour[0], view->colour[1], view->colour[2]}};
    int32_t *grid = t3r_take(&cut, T3R_GRID_NODES_(width, height) * 8);
    job.work = t3r_take(&cut, rt->config.workers * T3R_IMAGE_ROW_BYTES_(width));
    job.depth = view->depth;
    if (resized->distortion != T3R_DISTORTION_NONE) {
        job.grid = grid;
        job.depth = t3r_take(&cut, pixels * sizeof *job.depth);
        uint8_t *colour = t3r_take(&cut, 3 * pixels);
        for (int c = 0; c < 3; c++) {
            job.colour[c] = colour + (size_t)c * pixels;
        }
    }
    return job;
}

static t3r_status make_grid(const develop_job *job, const t3r_camera *resized)
{
    return job->grid == NULL ? T3R_OK : t3r_undistort_grid(resized, job->view->width, job->view->height, job->grid);
}

/* Completes a view after the last resized row; *camera loses its lens. */
static void finish(const t3r_runtime *rt, develop_job *job, t3r_camera *camera)
{
    const t3r_workers workers = t3r_workers_of(rt);
    if (job->grid != NULL) {
        t3r_run_rows(&workers, job->view->height, undistort_rows, job);
    }
    t3r_depth_validity(job->view);
    camera->distortion = T3R_DISTORTION_NONE;
    for (int i = 0; i < 5; i++) {
        camera->distortion_q24[i] = 0;
    }
}

t3r_status t3r_develop_view(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, t3r_camera *camera)
{
    t3r_view view = t3r_view_of(rt, index);
    develop_job job = job_of(rt, frame, &view, camera);
    const t3r_status status = make_grid(&job, camera);
    if (status == T3R_OK) {
        const t3r_workers workers = t3r_workers_of(rt);
        t3r_run_rows(&workers, view.height, resize_rows, &job);
        finish(rt, &job, camera);
    }
    return status;
}

t3r_status t3r_develop_strip(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_strip *strip,
                             t3r_camera *camera)
{
    t3r_view view = t3r_view_of(rt, index);
    develop_job job = job_of(rt, frame, &view, camera);
    const t3r_status status = strip->begins ? make_grid(&job, camera) : T3R_OK; /* kept until the last strip */
    if (status != T3R_OK) {
        return status;
    }
    t3r_image_colour_strip(&rt->kernels, frame, view.width, view.height, strip->row, strip->rows, job.colour, job.work);
    if (!t3r_is_by_stereo(&rt->config)) {
        t3r_image_depth_strip(frame, view.width, view.height, strip->depth_row, strip->depth_rows, job.depth);
    } else if (strip->ends) {
        t3r_image_depth(frame, view.width, view.height, 0, view.height, job.depth);
    }
    if (strip->ends) {
        finish(rt, &job, camera);
    }
    return T3R_OK;
}
