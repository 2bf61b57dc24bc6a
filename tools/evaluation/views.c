/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/views.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "geometry/seen.h"
#include "reconstruction/context_points.h"
#include "reconstruction/developed_frame.h"

static void free_picture(const evaluation_picture *picture)
{
    free(picture->rgb);
    free(picture->depth);
    free(picture->shown);
    free(picture->mask);
}

void evaluation_views_free(evaluation_views *views)
{
    free_picture(&views->target);
    for (uint32_t v = 0; v < views->context_count; v++) {
        free_picture(&views->context[v]);
    }
    method_source_close(&views->source);
    *views = (evaluation_views){0};
}

/* Returns false if out of memory. */
static bool allocate_picture(evaluation_picture *picture, size_t pixels, bool sensed)
{
    picture->rgb = malloc(pixels * 3);
    picture->depth = sensed ? malloc(pixels * sizeof *picture->depth) : NULL;
    picture->shown = malloc(pixels);
    picture->mask = malloc(pixels);
    return picture->rgb != NULL && (picture->depth != NULL || !sensed) && picture->shown != NULL &&
           picture->mask != NULL;
}

/* Gives a camera the recorded pose of frame `index`, if poses are estimated and the frame has one. */
static void place(t3r_camera *camera, const evaluation_case *what, uint32_t index)
{
    t3r_capture_frame frame;
    char error[512];
    const bool is_recorded =
        what->recorded != NULL &&
        t3r_recording_frame(what->recorded, index, &frame, error, sizeof error) == T3R_CAPTURE_FRAME && frame.has_pose;
    if (is_recorded) {
        memcpy(camera->position_q32, frame.camera.position_q32, sizeof camera->position_q32);
        memcpy(camera->rotation_q30, frame.camera.rotation_q30, sizeof camera->rotation_q30);
    }
}

/* Makes frame `index` as the image stage outputs it, but for its mask. */
static int make_picture(evaluation_picture *picture, const evaluation_views *views, const evaluation_case *what,
                        uint32_t index)
{
    const uint32_t w = views->width, h = views->height;
    t3r_capture_frame frame;
    int code = recorded_frame_read(what->recording, what->path, index, &frame);
    if (code == CLI_OK && !allocate_picture(picture, (size_t)w * h, frame.frame.depth != NULL)) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    if (code == CLI_OK) {
        picture->depth_unit = ldexp((double)frame.frame.depth_unit_q40, -40);
        code = developed_capture(&frame, what->path, index, w, h, picture->rgb, picture->depth, &picture->camera);
    }
    picture->placed = picture->camera;
    place(&picture->placed, what, index);
    return code == CLI_OK ? developed_shown(&frame, what->path, index, w, h, picture->shown) : code;
}

static int make_pictures(evaluation_views *views, const evaluation_case *what)
{
    int code = make_picture(&views->target, views, what, what->target);
    for (uint32_t v = 0; v < what->context_count && code == CLI_OK; v++) {
        views->context_count = v + 1;
        code = make_picture(&views->context[v], views, what, what->context[v]);
    }
    return code;
}

static bool all_have_depth(const evaluation_views *views)
{
    bool all = views->target.depth != NULL;
    for (uint32_t v = 0; v < views->context_count; v++) {
        all = all && views->context[v].depth != NULL;
    }
    return all;
}

static seen_view view_of(const evaluation_picture *picture)
{
    return (seen_view){&picture->placed, picture->depth, picture->depth_unit};
}

/* Marks the pixels of a picture that count. */
static void make_mask(const evaluation_picture *picture, const evaluation_views *views)
{
    const size_t pixels = (size_t)views->width * views->height;
    if (!views->sensed) {
        memcpy(picture->mask, picture->shown, pixels);
        return;
    }
    seen_view view = view_of(picture), context[T3R_MAX_VIEWS];
    for (uint32_t v = 0; v < views->context_count; v++) {
        context[v] = view_of(&views->context[v]);
    }
    seen_mask(picture->mask, views->width, views->height, &view, context, views->context_count);
    for (size_t i = 0; i < pixels; i++) {
        picture->mask[i] &= picture->shown[i];
    }
}

int evaluation_views_make(evaluation_views *views, const evaluation_case *what, const reconstruction_options *settings)
{
    reconstruction_options options = *settings;
    reconstruction sized = {.context_count = 0};
    options.context_count = what->context_count;
    memcpy(options.context, what->context, sizeof options.context);
    int code = reconstruction_views(&sized, what->recording, what->path, &options);
    *views = (evaluation_views){.width = sized.config.width, .height = sized.config.height};
    code = code == CLI_OK ? make_pictures(views, what) : code;
    if (code != CLI_OK) {
        evaluation_views_free(views);
        return code;
    }
    views->sensed = !what->planar && all_have_depth(views);
    make_mask(&views->target, views);
    for (uint32_t v = 0; v < views->context_count; v++) {
        make_mask(&views->context[v], views);
    }
    return CLI_OK;
}
