/* SPDX-License-Identifier: Apache-2.0 */
#include "capture/live_build.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "messages/pixel_layout.h"
#include "reconstruction/lens_masks.h"
#include "reconstruction/reconstruction_error.h"

/* Returns the bytes of all rows without padding. */
static size_t all_bytes(const t3r_frame *f)
{
    size_t rows = (size_t)t3r_pixel_rows(f->format, 0, f->height) + t3r_pixel_rows(f->format, 1, f->height);
    size_t depth = f->depth == NULL ? 0 : (size_t)f->depth_width * f->depth_height * 2;
    return rows * t3r_pixel_row_bytes(f->format, f->width) + depth;
}

const char *live_build_lacks(const t3r_capture_frame *frame)
{
    return frame->frame.depth == NULL ? "depth"
           : !frame->has_pose         ? "pose"
           : !frame->has_intrinsics   ? "intrinsics"
                                      : NULL;
}

/* Returns the largest budget that a build may request. */
static uint32_t most_gaussians(const live_build *build)
{
    uint64_t points = (uint64_t)build->r.config.width * build->r.config.height * build->r.context_count;
    uint64_t most = points;
    if (build->options.automatic) { /* it compares with a scene of all points */
        most = points;
    } else if (build->options.gaussians != 0) {
        most = build->options.gaussians;
    } else if (build->options.keep_percent > 0) {
        most = (uint64_t)ceil((double)points * build->options.keep_percent / 100) + 1;
    }
    most = most < points ? most : points;
    return most < T3R_MAX_GAUSSIANS ? (uint32_t)most : T3R_MAX_GAUSSIANS;
}

static int open_arena(live_build *build)
{
    reconstruction *r = &build->r;
    reconstruction_configure(r, &build->options);
    r->config.gaussians = r->config.max_gaussians = most_gaussians(build);
    return reconstruction_allocate(r, &build->options);
}

static int open_build(live_build *build, uint32_t views, const t3r_capture_frame *like)
{
    reconstruction *r = &build->r;
    int code = chosen_head_open(&r->head, build->options.head);
    if (code != CLI_OK) {
        return code;
    }
    r->context_count = views;
    r->config.width = build->options.config.width != 0 ? build->options.config.width : like->frame.width;
    r->config.height = build->options.config.height != 0 ? build->options.config.height : like->frame.height;
    code = open_arena(build);
    if (code != CLI_OK) {
        return code;
    }
    size_t pixels = (size_t)r->config.width * r->config.height;
    build->rgb = malloc(pixels * 3);
    build->depth = malloc(pixels * sizeof *build->depth);
    bool done = build->rgb != NULL && build->depth != NULL;
    build->room = views - 1;
    build->frame_bytes = all_bytes(&like->frame);
    for (uint32_t i = 0; i < build->room && done; i++) {
        build->kept[i].bytes = malloc(build->frame_bytes);
        done = build->kept[i].bytes != NULL;
    }
    return done ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
}

int live_build_open(live_build *build, const reconstruction_options *options, uint32_t views,
                    const t3r_capture_frame *like)
{
    *build = (live_build){.options = *options};
    int code = open_build(build, views, like);
    if (code != CLI_OK) {
        live_build_close(build);
    }
    return code;
}

void live_build_close(live_build *build)
{
    for (uint32_t i = 0; i < T3R_MAX_VIEWS; i++) {
        free(build->kept[i].bytes);
    }
    free(build->rgb);
    free(build->depth);
    reconstruction_close(&build->r);
    *build = (live_build){0};
}

/* Copies rows without padding: a driver's buffer may end after the last row's samples. */
static const uint8_t *copy_rows(uint8_t **to, const uint8_t *from, uint32_t rows, size_t row_bytes, size_t stride_bytes)
{
    const uint8_t *start = *to;
    for (uint32_t y = 0; y < rows; y++, *to += row_bytes) {
        memcpy(*to, from + y * stride_bytes, row_bytes);
    }
    return start;
}

int live_build_keep(live_build *build, const t3r_capture_frame *frame)
{
    const t3r_frame *f = &frame->frame;
    if (build->room == 0) {
        return CLI_OK;
    }
    if (all_bytes(f) > build->frame_bytes) {
        return cli_error(CLI_BAD_INPUT,
                         "frame %" PRIu32 " is larger than the first one of the build: the format changed",
                         frame->index);
    }
    if (build->kept_count == build->room) {
        live_frame oldest = build->kept[0];
        memmove(build->kept, build->kept + 1, (build->room - 1) * sizeof oldest);
        build->kept[build->room - 1] = oldest;
        build->kept_count--;
    }
    live_frame *kept = &build->kept[build->kept_count++];
    uint8_t *to = kept->bytes;
    kept->frame = *frame;
    t3r_frame *packed = &kept->frame.frame;
    uint32_t row_bytes = t3r_pixel_row_bytes(f->format, f->width);
    for (uint32_t p = 0; p < 2 && t3r_pixel_rows(f->format, p, f->height) > 0; p++) {
        uint32_t rows = t3r_pixel_rows(f->format, p, f->height);
        packed->planes[p] = copy_rows(&to, f->planes[p], rows, row_bytes, f->stride_bytes[p]);
        packed->stride_bytes[p] = row_bytes;
    }
    if (f->depth != NULL) {
        size_t depth_row_bytes = (size_t)f->depth_width * 2;
        packed->depth = copy_rows(&to, f->depth, f->depth_height, depth_row_bytes, f->depth_stride_bytes);
        packed->depth_stride_bytes = (uint32_t)depth_row_bytes;
    }
    return CLI_OK;
}

/* Counts the valid points of all views, in the arena that the build will use next. */
static int count_valid_points(live_build *build, const t3r_capture_frame *const *frames)
{
    reconstruction *r = &build->r;
    t3r_config config = t3r_default_config(r->config.width, r->config.height, 1, 1);
    size_t pixels = (size_t)config.width * config.height;
    t3r_runtime *runtime;
    r->valid_points = 0;
    t3r_status status = t3r_init(&runtime, r->arena, r->arena_bytes, &config);
    if (status != T3R_OK) {
        return reconstruction_error(status, "settings", &config, r->arena_bytes);
    }
    for (uint32_t v = 0; v < r->context_count; v++) {
        t3r_camera camera;
        status = t3r_develop(runtime, &frames[v]->frame, &frames[v]->camera, build->rgb, build->depth, &camera);
        if (status != T3R_OK) {
            return reconstruction_view_error(status, runtime, NULL, frames[v]->index, frames[v]);
        }
        for (size_t i = 0; i < pixels; i++) {
            r->valid_points += build->depth[i] != 0;
        }
    }
    return r->valid_points > 0 ? CLI_OK
                               : cli_error(CLI_BAD_INPUT, "frame %" PRIu32 ": no valid depth", frames[0]->index);
}

static int start_runtime(live_build *build)
{
    reconstruction *r = &build->r;
    reconstruction_request(r, &build->options);
    t3r_status status = t3r_init(&r->runtime, r->arena, r->arena_bytes, &r->config);
    if (status == T3R_OK) {
        t3r_hooks hooks = reconstruction_hooks(r, &build->options);
        (void)t3r_set_cpu(r->runtime, build->options.processor.cpu);
        status = t3r_set_hooks(r->runtime, &hooks);
    }
    if (status == T3R_OK) {
        status = chosen_head_bind(&r->head, r->runtime, build->options.ablation);
    }
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, "arena", &r->config, r->arena_bytes);
}

int live_build_make(live_build *build, const t3r_capture_frame *newest)
{
    reconstruction *r = &build->r;
    const t3r_capture_frame *frames[T3R_MAX_VIEWS];
    for (uint32_t v = 0; v < build->kept_count; v++) {
        frames[v] = &build->kept[v].frame;
    }
    frames[build->kept_count] = newest;
    for (uint32_t v = 0; v < r->context_count; v++) {
        r->context[v] = frames[v]->index;
    }
    int code = count_valid_points(build, frames);
    if (code == CLI_OK) {
        code = start_runtime(build);
    }
    for (uint32_t v = 0; v < r->context_count && code == CLI_OK; v++) {
        code = lens_mask_find(r, &build->options, "capture", v, frames[v]);
    }
    if (code != CLI_OK) {
        return code;
    }
    reconstruction_clear_hashes(r);
    double start = cli_now();
    for (uint32_t v = 0; v < r->context_count; v++) {
        t3r_status status = t3r_add_view(r->runtime, &frames[v]->frame, &frames[v]->camera);
        if (status != T3R_OK) {
            return reconstruction_view_error(status, r->runtime, NULL, frames[v]->index, frames[v]);
        }
    }
    double added = cli_now();
    t3r_status status = reconstruction_make(r, &build->options, NULL);
    r->add_views_seconds = added - start;
    r->build_seconds = cli_now() - added;
    build->builds++;
    return status == T3R_OK ? CLI_OK : reconstruction_make_error(r, status, "build");
}
