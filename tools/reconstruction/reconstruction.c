/* SPDX-License-Identifier: Apache-2.0 */
/* One run of the runtime on a recording: arena, hooks, views, scene. */
#include "reconstruction/reconstruction.h"

#include <inttypes.h>
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "api/least.h"
#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "core/camera.h"
#include "core/fixed.h"
#include "core/hash.h"
#include "core/scene_frame.h"
#include "head/head.h"
#include "host/cpu.h"
#include "pipeline.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/importance_pictures.h"
#include "reconstruction/reconstruction_error.h"
#include "reconstruction/scene_frames.h"
#include "scene/scene_append.h"
#include "state/state.h"
#include "state/views.h"

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
    for (uint32_t v = 0; v < account.context_count && account.has_cameras; v++) {
        account.has_cameras = t3r_view_camera(r->runtime, v, &account.camera[v]) == T3R_OK;
    }
    return account;
}

uint32_t reconstruction_budget(uint32_t valid_points, double keep_percent)
{
    double points = floor(valid_points * keep_percent / 100 + 0.5);
    return points < 1 ? 1 : (uint32_t)points;
}

/* ---- hooks ------------------------------------------------------------------------------------------------ */

static int show_progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    const reconstruction *r = user;
    cli_progress(t3r_stage_name(stage), done, total);
    return r->give_up_at > 0 && cli_now() > r->give_up_at;
}

static void keep_hash(void *user, t3r_stage stage, uint64_t hash)
{
    reconstruction *r = user;
    if (r->uncounted) {
        return;
    }
    r->stage_hash[stage] = r->stage_hashed[stage] ? t3r_hash_u64(r->stage_hash[stage], hash) : hash;
    r->stage_hashed[stage] = true;
    stage_times_end(&r->stages, stage);
}

static void run_parallel(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                         void *context)
{
    reconstruction *r = user;
    t3r_threads_run(r->threads, count, task, context);
}

uint64_t reconstruction_hash(const reconstruction *r)
{
    uint64_t hash = T3R_HASH_START;
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (r->stage_hashed[stage]) {
            hash = t3r_hash_u64(t3r_hash_u8(hash, (uint8_t)stage), r->stage_hash[stage]);
        }
    }
    return hash;
}

void reconstruction_clear_hashes(reconstruction *r)
{
    memset(r->stage_hash, 0, sizeof r->stage_hash);
    memset(r->stage_hashed, 0, sizeof r->stage_hashed);
}

t3r_hooks reconstruction_hooks(reconstruction *r, const reconstruction_options *options)
{
    return (t3r_hooks){
        .user = r,
        .stage_hash = options->hash ? keep_hash : NULL,
        .parallel_for = r->threads != NULL ? run_parallel : NULL,
    };
}

/* ---- the arena -------------------------------------------------------------------------------------------- */

/* Returns the bytes with which no stage takes longer than with more: a view is drawn in one pass, and each worker packs
 * the layers of the head. */
static size_t full_bytes(const reconstruction *r, const t3r_plan_info *plan)
{
    const size_t packed =
        r->head.weights != NULL ? t3r_head_learned_packed_bytes(r->head.weights, r->config.width) : SIZE_MAX;
    if (packed == SIZE_MAX) { /* no network, or one that is not packed */
        return plan->bytes;
    }
    const size_t below = plan->buffers[T3R_BUFFER_HEAD_WORK].offset + r->config.workers * T3R_UP_(packed);
    return T3R_MAX(plan->bytes, below + plan->buffers[T3R_BUFFER_SCENE].bytes);
}

int reconstruction_allocate(reconstruction *r, const reconstruction_options *options)
{
    t3r_plan_info plan;
    r->config.workers = options->processor.threads;
    t3r_status status = t3r_plan(&r->config, &plan);
    if (status != T3R_OK) {
        return reconstruction_error(status, "settings", &r->config, 0);
    }
    uint64_t bytes = options->arena == ARENA_BYTES ? options->arena_bytes
                     : options->arena == ARENA_MIN ? plan.min_bytes
                                                   : full_bytes(r, &plan);
    if (bytes < plan.min_bytes) {
        return reconstruction_error(T3R_ERR_ARENA, "arena", &r->config, (size_t)bytes);
    }
    if (bytes > SIZE_MAX || posix_memalign(&r->arena, T3R_ARENA_ALIGN, (size_t)bytes) != 0) {
        r->arena = NULL;
        return cli_error(CLI_BAD_INPUT, "no memory for an arena of %" PRIu64 " bytes", bytes);
    }
    r->arena_bytes = (size_t)bytes;
    if (options->processor.threads > 1) {
        r->threads = t3r_threads_start(options->processor.threads);
        if (r->threads == NULL) {
            return cli_error(CLI_BAD_INPUT, "the system refuses %" PRIu32 " threads", options->processor.threads);
        }
    }
    return CLI_OK;
}

/* Allocates an arena, initialises the runtime in it, and binds hooks. */
static int open_arena(reconstruction *r, const reconstruction_options *options)
{
    int code = reconstruction_allocate(r, options);
    if (code != CLI_OK) {
        return code;
    }
    t3r_status status = t3r_init(&r->runtime, r->arena, r->arena_bytes, &r->config);
    if (status != T3R_OK) {
        return reconstruction_error(status, "arena", &r->config, r->arena_bytes);
    }
    t3r_hooks hooks = reconstruction_hooks(r, options);
    hooks.progress = show_progress;
    (void)t3r_set_cpu(r->runtime, options->processor.cpu);
    status = t3r_set_hooks(r->runtime, &hooks);
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, "hooks", &r->config, r->arena_bytes);
}

void reconstruction_close(reconstruction *r)
{
    cli_progress_end();
    t3r_threads_stop(r->threads);
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        free(r->shown[v]);
    }
    free(r->arena);
    chosen_head_close(&r->head);
    scene_file_free(&r->loaded);
    *r = (reconstruction){0};
}

/* ---- from a recording --------------------------------------------------------------------------------------- */

t3r_camera reconstruction_camera(const t3r_camera *camera, uint32_t from_width, uint32_t from_height, uint32_t width,
                                 uint32_t height)
{
    t3r_camera out = t3r_camera_resized(camera, from_width, from_height, width, height);
    out.distortion = T3R_DISTORTION_NONE;
    memset(out.distortion_q24, 0, sizeof out.distortion_q24);
    return out;
}

/* Reports which frames give no depth together, and why. */
static int stereo_error(const t3r_runtime *runtime, const reconstruction *r, const char *path)
{
    uint32_t partner;
    t3r_pair pair = t3r_stereo_pair(runtime, 0, &partner);
    return cli_error(CLI_BAD_INPUT, "%s: frames %" PRIu32 " and %" PRIu32 " give no depth%s: %s", path, r->context[0],
                     r->context[partner], r->context_count > 2 ? ", nor any other two" : "", t3r_pair_text(pair));
}

int reconstruction_make_error(const reconstruction *r, t3r_status status, const char *what)
{
    return status == T3R_ERR_STEREO ? stereo_error(r->runtime, r, what)
                                    : cli_error(CLI_BAD_INPUT, "%s: %s", what, r->reason);
}

/* Builds a scene; r->reason gets the reason of an error. */
static t3r_status make(reconstruction *r, const t3r_request *request)
{
    const t3r_status status = t3r_reconstruct(r->runtime, request, &r->scene);
    if (status != T3R_OK) {
        (void)t3r_reconstruct_error(status, r->runtime, request, &r->scene, r->reason, sizeof r->reason);
    }
    return status;
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

/* Counts points by stereo, which needs the depth: `counted`, which is all 0, keeps it for the build. The caller closes
 * it. */
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
    int code = open_arena(counted, &(reconstruction_options){.arena = ARENA_MIN, .processor = options->processor});
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

static int count_points(const reconstruction *r, const t3r_capture_frame *frames, const char *path,
                        const reconstruction_options *options, reconstruction_points *points, reconstruction *counted)
{
    int code = options->config.depth == T3R_DEPTH_STEREO
                   ? count_matched_points(r, frames, path, options, points, counted)
                   : count_measured_points(r, frames, path, points);
    return code == CLI_OK && points->valid == 0
               ? cli_error(CLI_BAD_INPUT, "%s: the context frames hold no valid depth", path)
               : code;
}

static int choose_context(reconstruction *r, const t3r_recording *recording, const char *path,
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
    return choose_context(r, recording, path, options, frames);
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

int reconstruction_count(reconstruction_points *points, const t3r_recording *recording, const char *path,
                         const reconstruction_options *options)
{
    reconstruction r = {.context_count = 0}, counted = {.context_count = 0};
    t3r_capture_frame frames[T3R_MAX_VIEWS];
    int code = choose_context(&r, recording, path, options, frames);
    code = code == CLI_OK ? need_depth(&r, path, frames, options->config.depth) : code;
    code = code == CLI_OK ? count_points(&r, frames, path, options, points, &counted) : code;
    reconstruction_close(&counted);
    return code;
}

static int bind_head(reconstruction *r, const reconstruction_options *options)
{
    t3r_status status = chosen_head_bind(&r->head, r->runtime, options->ablation);
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, r->head.name, &r->config, r->arena_bytes);
}

/* Analyses the views by building a scene of one Gaussian. */
static t3r_status analyse(reconstruction *r, t3r_request request)
{
    request.gaussians = 1;
    return make(r, &request);
}

/* Builds the fewest Gaussians that draw the context views at options->min_psnr. */
static t3r_status make_least(reconstruction *r, const reconstruction_options *options, t3r_request request)
{
    const uint32_t width = r->config.width, height = r->config.height;
    uint8_t *rgb = malloc((size_t)width * height * 3);
    const t3r_target picture = {.width = width, .height = height, .rgb = rgb, .rgb_stride_bytes = 3 * width};
    t3r_status status = T3R_ERR_ARENA;
    if (rgb != NULL) {
        status = analyse(r, request);
    } else {
        snprintf(r->reason, sizeof r->reason, "out of memory");
    }
    if (status == T3R_OK) {
        const uint32_t psnr_q8 = (uint32_t)(options->min_psnr * 256 + 0.5);
        status = t3r_rebuild_least_counted(r->runtime, &request, psnr_q8, &picture, (const uint8_t *const *)r->shown,
                                           &r->scene, &r->least);
        (void)t3r_rebuild_least_error(status, r->runtime, &request, psnr_q8, &picture, &r->scene, &r->least, r->reason,
                                      sizeof r->reason);
    }
    free(rgb);
    return status;
}

/* Builds the fewest Gaussians that lose at most options->max_loss. */
static t3r_status make_automatic(reconstruction *r, const reconstruction_options *options, t3r_request request)
{
    const t3r_status status = analyse(r, request);
    request.gaussians = r->config.gaussians;
    return status == T3R_OK ? measured_loss_build(r->runtime, &r->config, &request, options->max_loss, &r->scene,
                                                  &r->loss, r->reason)
                            : status;
}

t3r_status reconstruction_make(reconstruction *r, const reconstruction_options *options, const uint16_t *const *planes)
{
    const t3r_request request = {.importance = planes, .importance_stride_bytes = r->config.width * 2};
    return options->min_psnr > 0 ? make_least(r, options, request)
           : options->automatic  ? make_automatic(r, options, request)
                                 : make(r, &request);
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
 * (0). `counted` is as with count_matched_points(). */
static int prepare(reconstruction *r, const char *path, const reconstruction_options *options,
                   const t3r_capture_frame *frames, uint32_t keyframes, reconstruction *counted)
{
    int code = chosen_head_open(&r->head, options->head);
    if (code == CLI_OK && options->hide_mask) {
        code = chosen_head_hide_mask(&r->head);
    }
    if (code == CLI_OK) {
        code = need_depth(r, path, frames, options->config.depth);
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
    code = count_points(r, frames, path, options, &points, counted);
    if (code != CLI_OK) {
        return code;
    }
    r->valid_points = points.valid;
    reconstruction_request(r, options);
    if (keyframes > 0) {
        r->config.gaussians = r->config.max_gaussians = r->requested;
    }

    code = open_arena(r, options);
    return code == CLI_OK ? bind_head(r, options) : code;
}

/* Marks the pixels beyond the lenses of the context views, which no score counts. */
static int find_shown(reconstruction *r, const char *path, const t3r_capture_frame *frames)
{
    const uint32_t width = r->config.width, height = r->config.height;
    int code = CLI_OK;
    for (uint32_t v = 0; v < r->context_count && code == CLI_OK; v++) {
        if (frames[v].camera.distortion != T3R_DISTORTION_NONE) {
            r->shown[v] = malloc((size_t)width * height);
            code = r->shown[v] != NULL ? developed_shown(&frames[v], path, r->context[v], width, height, r->shown[v])
                                       : cli_error(CLI_BAD_INPUT, "out of memory");
        }
    }
    return code;
}

/* Builds from the chosen frames; `planes` are the importance for the allocation `given`, else NULL. */
static int build_from(reconstruction *r, const char *path, const reconstruction_options *options,
                      const t3r_capture_frame *frames, const uint16_t *const *planes, reconstruction *counted)
{
    int code = prepare(r, path, options, frames, 0, counted);
    code = code == CLI_OK && options->min_psnr > 0 ? find_shown(r, path, frames) : code;
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
    int code = choose_context(r, recording, path, options, frames);
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
    int code = choose_context(r, recording, path, options, frames);
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
    code = open_arena(r, options);
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

/* ---- from a file ---------------------------------------------------------------------------------------------- */

static int append_loaded(reconstruction *r, const scene_eye *eye)
{
    uint32_t index = 0;
    t3r_status status = scene_append_all(r->runtime, &r->loaded, eye, &index);
    if (status != T3R_OK && index > 0) {
        char reason[T3R_ERROR_BYTES];
        return cli_error(
            CLI_BAD_INPUT, "Gaussian %" PRIu32 ": %s", index - 1,
            t3r_scene_append_error(status, r->runtime, &r->loaded.gaussians[index - 1], reason, sizeof reason));
    }
    if (status == T3R_OK) {
        status = t3r_get_scene(r->runtime, &r->scene);
    }
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, "scene", &r->config, r->arena_bytes);
}

int reconstruction_look_from(reconstruction *r, const t3r_camera *camera, uint32_t width, uint32_t height)
{
    if (r->loaded.gaussians == NULL) {
        return CLI_OK;
    }
    const scene_eye eye = {camera, width, height};
    const bool was_seen = r->is_seen;
    r->seen = scene_seen_from(&r->loaded, &eye);
    r->is_seen = scene_differs(&r->loaded, &r->seen);
    return was_seen || r->is_seen ? append_loaded(r, &eye) : CLI_OK;
}

double reconstruction_depth(const reconstruction *r, uint32_t depth_q20)
{
    return ldexp(seen_depth(&r->seen, depth_q20), r->scene.frame.exponent);
}

static int load(reconstruction *r, uint32_t width, uint32_t height, const reconstruction_options *options)
{
    uint32_t count = r->loaded.count == 0 ? 1 : r->loaded.count;
    r->config = t3r_default_config(T3R_MIN_SIDE, T3R_MIN_SIDE, 0, count);
    r->config.render_width = width;
    r->config.render_height = height;
    r->config.tile_splats = options->config.tile_splats;
    int code = open_arena(r, options);
    if (code != CLI_OK) {
        return code;
    }
    return append_loaded(r, NULL);
}

int reconstruction_load(reconstruction *r, scene_file *scene, uint32_t width, uint32_t height,
                        const reconstruction_options *options)
{
    *r = (reconstruction){.loaded = *scene};
    *scene = (scene_file){0};
    int code = load(r, width, height, options);
    if (code != CLI_OK) {
        reconstruction_close(r);
    }
    return code;
}
