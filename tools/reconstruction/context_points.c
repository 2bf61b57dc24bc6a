/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/context_points.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "pipeline.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/reconstruction_error.h"
#include "state/state.h"
#include "state/views.h"

int reconstruction_read_context(reconstruction *r, const t3r_recording *recording, const char *path,
                                const reconstruction_options *options, t3r_capture_frame *frames)
{
    r->context_count = options->context_count;
    memcpy(r->context, options->context, sizeof r->context);
    if (r->context_count == 0) {
        uint32_t frame_count = t3r_recording_frame_count(recording);
        r->context_count = frame_count < 2 ? 1 : 2;
        r->context[0] = 0;
        r->context[1] = 1;
    }
    for (uint32_t v = 0; v < r->context_count; v++) {
        for (uint32_t earlier = 0; earlier < v; earlier++) {
            if (r->context[earlier] == r->context[v]) {
                return cli_error(CLI_BAD_USAGE, "--context names frame %" PRIu32 " twice", r->context[v]);
            }
        }
        int code = recorded_frame_read(recording, path, r->context[v], &frames[v]);
        if (code != CLI_OK) {
            return code;
        }
    }
    r->config.width = options->config.width != 0 ? options->config.width : frames[0].frame.width;
    r->config.height = options->config.height != 0 ? options->config.height : frames[0].frame.height;
    return CLI_OK;
}

int reconstruction_views(reconstruction *r, const t3r_recording *recording, const char *path,
                         const reconstruction_options *options)
{
    t3r_capture_frame frames[T3R_MAX_VIEWS];
    return reconstruction_read_context(r, recording, path, options, frames);
}

/* Checks what the requested source of depth needs. */
static int need_depth(const reconstruction *r, const char *path, const t3r_capture_frame *frames, t3r_depth depth)
{
    if (depth == T3R_DEPTH_STEREO) {
        return r->context_count > 1
                   ? CLI_OK
                   : cli_error(CLI_BAD_INPUT, "%s: --depth stereo needs two context frames and more", path);
    }
    for (uint32_t v = 0; v < r->context_count; v++) {
        if (frames[v].frame.depth == NULL) {
            return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 " has no depth (--depth stereo needs none)", path,
                             r->context[v]);
        }
    }
    return CLI_OK;
}

/* Finds the points of the views that were added, in the time of `stages` and `build_seconds`. */
static t3r_status find_points(reconstruction *r)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(r->runtime, views);
    stage_times_begin(&r->stages, r->config.workers);
    const double start = cli_now();
    const t3r_status status = t3r_find_points(r->runtime, views);
    r->build_seconds = cli_now() - start;
    stage_times_end(&r->stages, T3R_STAGE_DEPTH);
    if (status != T3R_OK) {
        (void)t3r_reconstruct_error(status, r->runtime, NULL, &r->scene, r->reason, sizeof r->reason);
    }
    return status;
}

/* Counts points by stereo, which needs the depth: `counted` keeps it for the build. */
static int count_matched_points(const reconstruction *r, const t3r_capture_frame *frames, const char *path,
                                const reconstruction_options *options, reconstruction_points *points,
                                reconstruction *counted)
{
    counted->context_count = r->context_count;
    memcpy(counted->context, r->context, sizeof counted->context);
    t3r_config *c = &counted->config;
    *c = t3r_default_config(r->config.width, r->config.height, r->context_count, 1);
    c->depth = T3R_DEPTH_STEREO;
    c->flying = c->redundancy = c->exposure = c->refine = c->cluster_batches = 0;
    c->wavelet = T3R_WAVELET_HAAR;
    c->levels = c->clusters = c->render_width = c->render_height = 1;
    c->fill_radius = options->config.fill_radius;
    int code = reconstruction_open_arena(
        counted, &(reconstruction_options){.arena = ARENA_MIN, .processor = options->processor});
    t3r_status status = T3R_OK;
    for (uint32_t v = 0; v < r->context_count && code == CLI_OK; v++) {
        status = t3r_add_view(counted->runtime, &frames[v].frame, &frames[v].camera);
        code = status == T3R_OK ? CLI_OK
                                : reconstruction_view_error(status, counted->runtime, path, r->context[v], &frames[v]);
    }
    if (code == CLI_OK) {
        status = find_points(counted);
        code = status == T3R_OK ? CLI_OK : reconstruction_make_error(counted, status, path);
    }
    if (code == CLI_OK) {
        *points = (reconstruction_points){.valid = counted->runtime->valid_points,
                                          .depth = ldexp(1.5, counted->runtime->frame.exponent)};
    }
    return code;
}

/* Counts points in the developed depth: the runtime's own resize and undistortion decide which points exist. */
static int count_measured_points(const reconstruction *r, const t3r_capture_frame *frames, const char *path,
                                 reconstruction_points *points)
{
    const uint32_t width = r->config.width, height = r->config.height;
    const size_t pixels = (size_t)width * height;
    uint8_t *rgb = malloc(pixels * 3);
    uint16_t *depth = malloc(pixels * 2);
    int code = rgb != NULL && depth != NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
    *points = (reconstruction_points){.valid = 0};
    for (uint32_t v = 0; v < r->context_count && code == CLI_OK; v++) {
        t3r_camera camera;
        code = developed_capture(&frames[v], path, r->context[v], width, height, rgb, depth, &camera);
        for (size_t i = 0; i < pixels && code == CLI_OK; i++) {
            points->valid += depth[i] != 0;
        }
    }
    free(depth);
    free(rgb);
    return code;
}

int reconstruction_count_points(const reconstruction *r, const t3r_capture_frame *frames, const char *path,
                                const reconstruction_options *options, reconstruction_points *points,
                                reconstruction *counted)
{
    int code = need_depth(r, path, frames, options->config.depth);
    if (code == CLI_OK) {
        code = options->config.depth == T3R_DEPTH_STEREO
                   ? count_matched_points(r, frames, path, options, points, counted)
                   : count_measured_points(r, frames, path, points);
    }
    return code == CLI_OK && points->valid == 0
               ? cli_error(CLI_BAD_INPUT, "%s: the context frames hold no valid depth", path)
               : code;
}

int reconstruction_count(reconstruction_points *points, const t3r_recording *recording, const char *path,
                         const reconstruction_options *options)
{
    reconstruction r = {.context_count = 0}, counted = {.context_count = 0};
    t3r_capture_frame frames[T3R_MAX_VIEWS];
    int code = reconstruction_read_context(&r, recording, path, options, frames);
    code = code == CLI_OK ? reconstruction_count_points(&r, frames, path, options, points, &counted) : code;
    reconstruction_close(&counted);
    return code;
}
