/* SPDX-License-Identifier: Apache-2.0 */
/* One run of the runtime on a recording: arena, hooks, views, scene. */
#include "reconstruction/reconstruction.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/camera.h"
#include "reconstruction/context_points.h"
#include "reconstruction/importance_pictures.h"
#include "reconstruction/lens_masks.h"
#include "reconstruction/reconstruction_error.h"
#include "reconstruction/scene_frames.h"
#include "state/state.h"

void reconstruction_defaults(reconstruction_options *options)
{
    *options = (reconstruction_options){
        .config = t3r_default_config(0, 0, 0, 1),
        .context_views = 2,
        .head = CHOSEN_HEAD_DEFAULT,
        .hash = true,
        .arena = ARENA_FULL,
        .processor = processor_defaults(),
    };
}

void reconstruction_warn_of_budget(const reconstruction_options *options, uint32_t requested, uint32_t count)
{
    if (requested > count && !reconstruction_chooses(options)) {
        (void)cli_error(CLI_OK,
                        "warning: %" PRIu32 " Gaussians are more than the views have: all %" PRIu32
                        " valid points are used",
                        requested, count);
    }
}

reconstruction_account reconstruction_account_of(const reconstruction *r)
{
    reconstruction_account account = {
        .width = r->config.width,
        .height = r->config.height,
        .context_count = r->context_count,
        .valid_points = r->valid_points,
        .requested = r->requested,
        .arena_bytes = r->arena_bytes,
        .seconds = r->add_views_seconds + r->build_seconds,
    };
    memcpy(account.head, r->head.name, sizeof account.head);
    memcpy(account.bits, r->head.bits, sizeof account.bits);
    memcpy(account.crc, r->head.crc, sizeof account.crc);
    memcpy(account.context, r->context, sizeof account.context);
    account.has_cameras = r->runtime != NULL && account.context_count > 0;
    account.unit = ldexp(1, r->scene.frame.exponent);
    for (uint32_t v = 0; v < account.context_count && account.has_cameras; v++) {
        account.has_cameras = t3r_view_camera(r->runtime, v, &account.camera[v]) == T3R_OK &&
                              t3r_view_gain(r->runtime, v, account.gain_q14[v]) == T3R_OK;
    }
    return account;
}

uint32_t reconstruction_budget(uint32_t valid_points, double keep_percent)
{
    double points = floor(valid_points * keep_percent / 100 + 0.5);
    return points < 1 ? 1 : (uint32_t)points;
}

t3r_camera reconstruction_camera(const t3r_camera *camera, uint32_t from_width, uint32_t from_height, uint32_t width,
                                 uint32_t height)
{
    t3r_camera out = t3r_camera_resized(camera, from_width, from_height, width, height);
    out.distortion = T3R_DISTORTION_NONE;
    memset(out.distortion_q24, 0, sizeof out.distortion_q24);
    return out;
}

static int bind_head(reconstruction *r, const reconstruction_options *options)
{
    t3r_status status = chosen_head_bind(&r->head, r->runtime, options->ablation);
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, r->head.name, &r->config, r->arena_bytes);
}

void reconstruction_configure(reconstruction *r, const reconstruction_options *options)
{
    const uint32_t width = r->config.width, height = r->config.height;
    r->config = options->config;
    r->config.width = width;
    r->config.height = height;
    r->config.views = r->context_count;
    if (r->config.render_width == 0) {
        r->config.render_width = width;
        r->config.render_height = height;
    }
    chosen_head_configure(&r->head, &r->config);
    r->config.keep_analysis |= reconstruction_chooses(options);
}

void reconstruction_request(reconstruction *r, const reconstruction_options *options)
{
    uint32_t all = r->pruned != 0 ? r->pruned : r->valid_points;
    r->requested = options->gaussians != 0     ? options->gaussians
                   : options->keep_percent > 0 ? reconstruction_budget(all, options->keep_percent)
                                               : all;
    r->config.gaussians = T3R_MIN(r->requested, r->valid_points);
    r->config.max_gaussians = options->automatic ? r->valid_points : r->config.gaussians; /* it compares with all */
}

/* Prepares head, settings, budget and arena, for a stream with `keyframes` live keyframes, or for the context frames
 * (0). `counted` is as with reconstruction_count_points(). */
static int prepare(reconstruction *r, const char *path, const reconstruction_options *options,
                   const t3r_capture_frame *frames, uint32_t keyframes, reconstruction *counted)
{
    int code = chosen_head_open(&r->head, options->head);
    if (code == CLI_OK && options->hide_mask) {
        code = chosen_head_hide_mask(&r->head);
    }
    if (code != CLI_OK) {
        return code;
    }
    reconstruction_configure(r, options);
    if (keyframes > 0) {
        r->config.stream = 1;
        r->config.views = keyframes;
    }
    if (t3r_config_error(&r->config) != NULL) {
        return reconstruction_error(T3R_ERR_CONFIG, "settings", &r->config, 0);
    }

    reconstruction_points points;
    code = reconstruction_count_points(r, frames, path, options, &points, counted);
    if (code != CLI_OK) {
        return code;
    }
    r->valid_points = points.valid;
    reconstruction_request(r, options);
    if (keyframes > 0) {
        r->config.gaussians = r->config.max_gaussians = r->requested;
    }

    code = reconstruction_open_arena(r, options);
    return code == CLI_OK ? bind_head(r, options) : code;
}

/* Builds from the chosen frames; `planes` are the importance for the allocation `given`, else NULL. */
static int build_from(reconstruction *r, const char *path, const reconstruction_options *options,
                      const t3r_capture_frame *frames, const uint16_t *const *planes, reconstruction *counted)
{
    int code = prepare(r, path, options, frames, 0, counted);
    for (uint32_t v = 0; v < r->context_count && code == CLI_OK; v++) {
        code = lens_mask_find(r, options, path, v, &frames[v]);
    }
    if (code != CLI_OK) {
        return code;
    }
    double start = cli_now();
    stage_times_begin(&r->stages, options->processor.threads);
    r->stages.seconds[T3R_STAGE_DEPTH] = counted->stages.seconds[T3R_STAGE_DEPTH];
    r->runtime->depth_of = counted->runtime;
    for (uint32_t v = 0; v < r->context_count; v++) {
        t3r_status status = t3r_add_view(r->runtime, &frames[v].frame, &frames[v].camera);
        if (status != T3R_OK) {
            return reconstruction_view_error(status, r->runtime, path, r->context[v], &frames[v]);
        }
    }
    double added = cli_now();
    r->add_views_seconds += added - start;
    t3r_status status = reconstruction_make(r, options, planes);
    r->build_seconds = counted->build_seconds + cli_now() - added;
    cli_progress_end();
    return status == T3R_OK ? CLI_OK : reconstruction_make_error(r, status, path);
}

/* The same, after reading the importance for the allocation `given`. */
static int build(reconstruction *r, const t3r_recording *recording, const char *path,
                 const reconstruction_options *options)
{
    t3r_capture_frame frames[T3R_MAX_VIEWS];
    reconstruction counted = {0};
    scene_frames made = {0};
    importance_pictures pictures = {0};
    const uint16_t *const *planes = NULL;
    int code = reconstruction_read_context(r, recording, path, options, frames);
    if (code == CLI_OK && options->points_of != NULL) {
        code = scene_frames_make(&made, options->points_of, options->scene_flags, recording, path, r->context,
                                 r->context_count, r->config.width, r->config.height, frames);
        r->pruned = made.gaussians;
        r->add_views_seconds = made.seconds;
    }
    if (options->config.allocate == T3R_ALLOCATE_GIVEN) {
        planes = options->importance_planes;
    }
    if (code == CLI_OK && options->config.allocate == T3R_ALLOCATE_GIVEN && options->importance != NULL) {
        code = importance_pictures_read(&pictures, options->importance, r->context, r->context_count, r->config.width,
                                        r->config.height);
        planes = (const uint16_t *const *)pictures.planes;
    }
    if (code == CLI_OK) {
        code = build_from(r, path, options, frames, planes, &counted);
    }
    reconstruction_close(&counted);
    importance_pictures_free(&pictures);
    scene_frames_free(&made);
    return code;
}

int reconstruction_build(reconstruction *r, const t3r_recording *recording, const char *path,
                         const reconstruction_options *options)
{
    *r = (reconstruction){0};
    int code = build(r, recording, path, options);
    if (code != CLI_OK) {
        reconstruction_close(r);
    }
    return code;
}

int reconstruction_stream(reconstruction *r, const t3r_recording *recording, const char *path,
                          const reconstruction_options *options, uint32_t keyframes)
{
    *r = (reconstruction){0};
    reconstruction counted = {0};
    t3r_capture_frame frames[T3R_MAX_VIEWS];
    int code = reconstruction_read_context(r, recording, path, options, frames);
    if (code == CLI_OK) {
        code = prepare(r, path, options, frames, keyframes, &counted);
    }
    reconstruction_close(&counted);
    if (code != CLI_OK) {
        reconstruction_close(r);
    }
    return code;
}

static int open_live_stream(reconstruction *r, const reconstruction_options *options, uint32_t keyframes)
{
    int code = chosen_head_open(&r->head, options->head);
    if (code != CLI_OK) {
        return code;
    }
    reconstruction_configure(r, options);
    r->config.stream = 1;
    r->config.views = keyframes;
    r->config.gaussians = r->config.max_gaussians = r->requested = options->gaussians;
    if (t3r_config_error(&r->config) != NULL) {
        return reconstruction_error(T3R_ERR_CONFIG, "settings", &r->config, 0);
    }
    code = reconstruction_open_arena(r, options);
    return code == CLI_OK ? bind_head(r, options) : code;
}

int reconstruction_live_stream(reconstruction *r, uint32_t width, uint32_t height,
                               const reconstruction_options *options, uint32_t keyframes)
{
    *r = (reconstruction){.config = {.width = width, .height = height}};
    int code = open_live_stream(r, options, keyframes);
    if (code != CLI_OK) {
        reconstruction_close(r);
    }
    return code;
}

int reconstruction_attach(reconstruction *r, const reconstruction_options *options)
{
    const t3r_status status = t3r_attach(&r->runtime, r->arena, r->arena_bytes);
    if (status != T3R_OK) {
        return reconstruction_error(status, "state", &r->config, r->arena_bytes);
    }
    (void)t3r_set_cpu(r->runtime, options->processor.cpu);
    return bind_head(r, options);
}
