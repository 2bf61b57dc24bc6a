/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/evaluation.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>

#include "cli/cli.h"
#include "cli/files/part_files.h"
#include "cli/files/recorded_frame.h"
#include "geometry/seen.h"
#include "pictures/metrics.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/reconstruction_error.h"
#include "scene/scene_file.h"

/* alpha_q15 is one minus transmittance; 32767 is the runtime's one */
#define ALPHA_ONE 32767u
#define MASK_TRANSMITTANCE 0.3
#define HOLE_TRANSMITTANCE 0.5

static double transmittance(uint16_t alpha_q15)
{
    return (double)(ALPHA_ONE - (alpha_q15 > ALPHA_ONE ? ALPHA_ONE : alpha_q15)) / ALPHA_ONE;
}

int evaluation_draw(reconstruction *r, const t3r_camera *camera, const evaluation_views *views, uint8_t *rgb,
                    uint16_t *alpha)
{
    t3r_target target = {
        .width = views->width,
        .height = views->height,
        .rgb = rgb,
        .rgb_stride_bytes = views->width * 3,
        .alpha_q15 = alpha,
        .alpha_stride_bytes = views->width * 2,
    };
    int code = reconstruction_look_from(r, camera, views->width, views->height);
    if (code != CLI_OK) {
        return code;
    }
    t3r_status status = t3r_render(r->runtime, camera, &target);
    return status == T3R_OK ? CLI_OK : reconstruction_render_error(status, "render", r->runtime, camera, &target);
}

/* ---- shared by the rows of a case --------------------------------------------------------------------------- */

static void free_picture(const evaluation_picture *picture)
{
    free(picture->rgb);
    free(picture->shown);
    free(picture->mask);
}

void evaluation_views_free(evaluation_views *views)
{
    free_picture(&views->target);
    free(views->seen);
    for (uint32_t v = 0; v < views->context_count; v++) {
        free_picture(&views->context[v]);
    }
    method_source_close(&views->source);
    *views = (evaluation_views){0};
}

/* Makes frame `index` as the image stage outputs it, and the area that the unpruned scene in `r` covers. */
static int make_picture(evaluation_picture *picture, const evaluation_views *views, const evaluation_case *what,
                        uint32_t index, reconstruction *r, uint16_t *alpha)
{
    size_t pixels = (size_t)views->width * views->height;
    picture->rgb = malloc(pixels * 3);
    picture->shown = malloc(pixels);
    picture->mask = malloc(pixels);
    if (picture->rgb == NULL || picture->shown == NULL || picture->mask == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    t3r_capture_frame frame;
    int code = recorded_frame_read(what->recording, what->path, index, &frame);
    code = code == CLI_OK ? developed_capture(&frame, what->path, index, views->width, views->height, picture->rgb,
                                              NULL, &picture->camera)
                          : code;
    code =
        code == CLI_OK ? developed_shown(&frame, what->path, index, views->width, views->height, picture->shown) : code;
    if (code != CLI_OK || what->planar) {
        memset(picture->mask, 255, pixels);
        return code;
    }
    code = evaluation_draw(r, &picture->camera, views, NULL, alpha);
    for (size_t i = 0; i < pixels && code == CLI_OK; i++) {
        picture->mask[i] = transmittance(alpha[i]) < MASK_TRANSMITTANCE ? picture->shown[i] : 0;
    }
    return code;
}

static int make_pictures(evaluation_views *views, const evaluation_case *what, reconstruction *r)
{
    uint16_t *alpha = malloc((size_t)views->width * views->height * sizeof *alpha);
    if (alpha == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    int code = make_picture(&views->target, views, what, what->target, r, alpha);
    for (uint32_t v = 0; v < what->context_count && code == CLI_OK; v++) {
        views->context_count = v + 1;
        code = make_picture(&views->context[v], views, what, what->context[v], r, alpha);
    }
    free(alpha);
    return code;
}

/* Reads the depth of frame `index` at the working size; depth is allocated. */
static int read_depth(seen_view *view, uint16_t **depth, const evaluation_views *views, const evaluation_case *what,
                      uint32_t index, const evaluation_picture *picture)
{
    size_t pixels = (size_t)views->width * views->height;
    uint8_t *rgb = malloc(pixels * 3);
    *depth = calloc(pixels, sizeof **depth);
    t3r_camera camera;
    t3r_capture_frame frame;
    int code = rgb == NULL || *depth == NULL ? cli_error(CLI_BAD_INPUT, "out of memory")
                                             : recorded_frame_read(what->recording, what->path, index, &frame);
    if (code == CLI_OK) {
        *view = (seen_view){&picture->camera, *depth, ldexp((double)frame.frame.depth_unit_q40, -40)};
        code = developed_capture(&frame, what->path, index, views->width, views->height, rgb, *depth, &camera);
    }
    free(rgb);
    return code;
}

/* Marks the target's pixels that a context view saw too; every frame has a depth of its own. */
static int make_seen(evaluation_views *views, const evaluation_case *what)
{
    uint16_t *depth[1 + T3R_MAX_VIEWS] = {NULL};
    seen_view view[1 + T3R_MAX_VIEWS];
    int code = read_depth(&view[0], &depth[0], views, what, what->target, &views->target);
    for (uint32_t v = 0; v < views->context_count && code == CLI_OK; v++) {
        code = read_depth(&view[1 + v], &depth[1 + v], views, what, what->context[v], &views->context[v]);
    }
    views->seen = code == CLI_OK ? malloc((size_t)views->width * views->height) : NULL;
    if (views->seen != NULL) {
        seen_mask(views->seen, views->width, views->height, &view[0], &view[1], views->context_count);
    } else if (code == CLI_OK) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t v = 0; v <= views->context_count; v++) {
        free(depth[v]);
    }
    return code;
}

/* Whether a frame has a depth of its own. */
static int has_depth(const evaluation_case *what, uint32_t index, bool *has)
{
    t3r_capture_frame frame;
    int code = recorded_frame_read(what->recording, what->path, index, &frame);
    *has = code == CLI_OK && frame.frame.depth != NULL;
    return code;
}

/* Whether every context frame has a depth of its own. */
static int have_depth(const evaluation_case *what, bool *all)
{
    *all = true;
    for (uint32_t v = 0; v < what->context_count; v++) {
        bool has;
        int code = has_depth(what, what->context[v], &has);
        if (code != CLI_OK) {
            return code;
        }
        *all = *all && has;
    }
    return CLI_OK;
}

int evaluation_views_make(evaluation_views *views, const evaluation_case *what, const reconstruction_options *settings)
{
    /* all points of the raw depth with the plain analytic head for every comparison; the sensor's depth if all
     * frames have it */
    reconstruction_options options = *settings;
    bool sensed, target_sensed = false;
    int looked = have_depth(what, &sensed);
    if (looked == CLI_OK) {
        looked = has_depth(what, what->target, &target_sensed);
    }
    if (looked != CLI_OK) {
        return looked;
    }
    options.config.depth = sensed ? T3R_DEPTH_SENSOR : settings->config.depth;
    options.points_of = sensed ? NULL : settings->points_of;
    /* frames without depth: the mask is of the scene's own means */
    if (!sensed && settings->config.depth == T3R_DEPTH_SENSOR && settings->scene != NULL) {
        options.points_of = settings->scene;
    }
    options.gaussians = 0;
    options.keep_percent = 100;
    options.automatic = false;
    options.min_psnr = 0;
    options.config.fill_radius = options.config.bridge_radius = 0;
    options.head = "analytic";
    options.config.allocate = T3R_ALLOCATE_UNIFORM;
    options.config.flying = options.config.redundancy = options.config.exposure = options.config.fit_widths =
        options.config.align = 0;
    options.config.keep_analysis = options.config.backdrop = false;
    options.config.refine = 0;
    options.hash = false;
    options.arena = ARENA_FULL;
    options.context_count = what->context_count;
    memcpy(options.context, what->context, sizeof options.context);

    *views = (evaluation_views){0};
    reconstruction r;
    int code = reconstruction_build(&r, what->recording, what->path, &options);
    if (code != CLI_OK) {
        evaluation_views_free(views);
        return code;
    }
    views->width = r.config.width;
    views->height = r.config.height;
    code = make_pictures(views, what, &r);
    reconstruction_close(&r);
    if (code == CLI_OK && sensed && target_sensed && !what->planar) {
        code = make_seen(views, what);
    }
    if (code != CLI_OK) {
        evaluation_views_free(views);
    }
    return code;
}

/* ---- a row -------------------------------------------------------------------------------------------------- */

static double share_of_holes(const uint16_t *alpha, const uint8_t *mask, size_t pixels)
{
    size_t holes = 0, count = 0;
    for (size_t i = 0; i < pixels; i++) {
        if (mask[i] != 0) {
            count++;
            holes += transmittance(alpha[i]) > HOLE_TRANSMITTANCE;
        }
    }
    return count == 0 ? NAN : (double)holes / (double)count;
}

/* Draws the target and the context views from the scene in `r`, and scores them. */
static int score(evaluation_row *row, uint8_t *render, uint8_t *rgb, uint16_t *alpha, const evaluation_views *views,
                 bool planar, reconstruction *r)
{
    uint32_t w = views->width, h = views->height;
    const evaluation_picture *target = &views->target;
    double start = cli_now();
    int code = evaluation_draw(r, &target->camera, views, render, alpha);
    row->value[EVALUATION_RENDER_MS] = (cli_now() - start) * 1000;
    if (code != CLI_OK) {
        return code;
    }
    row->value[EVALUATION_SSIM] = metric_ssim(target->rgb, render, target->mask, w, h);
    row->value[EVALUATION_SHARP] = metric_sharp(target->rgb, render, target->mask, w, h);
    row->value[EVALUATION_PERCEPTUAL] = metric_flip(target->rgb, render, target->mask, w, h);
    row->value[EVALUATION_HOLES] = share_of_holes(alpha, target->mask, (size_t)w * h);
    row->value[EVALUATION_PSNR_ALL] = metric_psnr(target->rgb, render, target->shown, w, h);
    if (planar) {
        row->value[EVALUATION_PLANAR_PSNR] = row->value[EVALUATION_PSNR_ALL];
        return CLI_OK;
    }
    row->value[EVALUATION_PSNR] = metric_psnr(target->rgb, render, target->mask, w, h);
    row->value[EVALUATION_PSNR_SEEN] = views->seen != NULL ? metric_psnr(target->rgb, render, views->seen, w, h) : NAN;
    double sum = 0;
    for (uint32_t v = 0; v < views->context_count; v++) {
        code = evaluation_draw(r, &views->context[v].camera, views, rgb, alpha);
        if (code != CLI_OK) {
            return code;
        }
        sum += metric_psnr(views->context[v].rgb, rgb, views->context[v].mask, w, h);
    }
    row->value[EVALUATION_CONTEXT_PSNR] = views->context_count == 0 ? NAN : sum / views->context_count;
    return CLI_OK;
}

/* Passes the scene of `built` through a file: *loaded is the scene read back. */
static int through_file(reconstruction *loaded, const reconstruction *built, const evaluation_views *views,
                        const reconstruction_options *options)
{
    const char *folder = getenv("TMPDIR");
    char path[4096], error[512] = "";
    int length =
        snprintf(path, sizeof path, "%s/trim3r-eval-XXXXXX.ply", folder != NULL && *folder != '\0' ? folder : P_tmpdir);
    int file = length > 0 && (size_t)length < sizeof path ? mkstemps(path, 4) : -1;
    if (file < 0) {
        return cli_error(CLI_BAD_INPUT, "no temporary file can be made in TMPDIR");
    }
    close(file);
    scene_file scene;
    if (!part_files_add(path)) {
        unlink(path);
        return cli_error(CLI_BAD_INPUT, "%s: too many files at a time", path);
    }
    int failed = scene_file_write(path, &built->scene, 0, NULL, error, sizeof error);
    if (failed == 0) {
        failed = scene_file_read(path, SCENE_FILE_QUIET, &scene, error, sizeof error);
    }
    unlink(path);
    part_files_forget(path);
    if (failed != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    return reconstruction_load(loaded, &scene, views->width, views->height, options);
}

void evaluation_name_case(evaluation_row *row, const evaluation_case *what)
{
    size_t length = 0;
    snprintf(row->scene, sizeof row->scene, "%s", what->scene);
    for (uint32_t v = 0; v < what->context_count && length < sizeof row->context && !what->planar; v++) {
        length += (size_t)snprintf(row->context + length, sizeof row->context - length, "%s%" PRIu32, v == 0 ? "" : ",",
                                   what->context[v]);
    }
    if (!what->planar) {
        snprintf(row->target, sizeof row->target, "%" PRIu32, what->target);
    }
}

/* Names the number of SuperClusters, "auto" if the library chooses it: that depends on the working size, which is
 * known only once a scene is made. */
static void name_clusters(evaluation_row *row, uint32_t clusters)
{
    if (clusters == 0) {
        snprintf(row->clusters, sizeof row->clusters, "auto");
    } else {
        snprintf(row->clusters, sizeof row->clusters, "%" PRIu32, clusters);
    }
}

int evaluation_name_row(evaluation_row *row, const evaluation_case *what, evaluation_budget budget,
                        const reconstruction_options *settings)
{
    *row = (evaluation_row){0};
    for (int i = 0; i < EVALUATION_VALUE_COUNT; i++) {
        row->value[i] = NAN;
    }
    row->value[EVALUATION_BITS_EPOCH] = T3R_BITS_EPOCH;
    evaluation_name_case(row, what);
    row->allocate = row->wavelet = row->ablation = "";
    row->depth = what->planar                  ? "plane"
                 : settings->points_of != NULL ? "scene"
                                               : t3r_depth_name(settings->config.depth);
    evaluation_settings_rest(settings, row->settings);
    if (settings->scene != NULL) {
        row->method = EVALUATION_SCENE;
        return CLI_OK;
    }
    row->method = settings->method->name;
    const bool allocated = settings->method->allocates;
    const bool built = allocated || settings->points_of == NULL; /* others take Gaussians from the file */
    if (built) {
        snprintf(row->refine, sizeof row->refine, "%" PRIu32, settings->config.refine);
        row->wavelet = t3r_wavelet_name(settings->config.wavelet);
        snprintf(row->levels, sizeof row->levels, "%" PRIu32, settings->config.levels);
    }
    if (allocated) {
        row->allocate = t3r_allocation_name(settings->config.allocate);
        name_clusters(row, settings->config.clusters);
    }
    if (budget.gaussians > 0) {
        row->value[EVALUATION_REQUESTED] = budget.gaussians;
    } else {
        row->value[EVALUATION_KEEP] = budget.keep;
    }
    if (!built) {
        return CLI_OK;
    }
    chosen_head head;
    int code = chosen_head_open(&head, settings->head);
    if (code == CLI_OK) {
        snprintf(row->head, sizeof row->head, "%s", head.name);
        snprintf(row->bits, sizeof row->bits, "%s", head.bits);
        chosen_head_close(&head);
    }
    return code;
}

int evaluation_score(evaluation_row *row, uint8_t *render, const evaluation_views *views, const evaluation_case *what,
                     reconstruction *r)
{
    size_t pixels = (size_t)views->width * views->height;
    uint8_t *rgb = malloc(pixels * 3);
    uint16_t *alpha = malloc(pixels * sizeof *alpha);
    int code = rgb == NULL || alpha == NULL ? cli_error(CLI_BAD_INPUT, "out of memory")
                                            : score(row, render, rgb, alpha, views, what->planar, r);
    free(alpha);
    free(rgb);
    return code;
}

/* Measures a row of the settings' scene file. */
static int measure_scene(evaluation_row *row, uint8_t *render, const evaluation_views *views,
                         const evaluation_case *what, const reconstruction_options *options)
{
    scene_file scene;
    reconstruction loaded;
    char error[512] = "";
    if (scene_file_read(options->scene, options->scene_flags | SCENE_FILE_QUIET, &scene, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    row->value[EVALUATION_GAUSSIANS] = scene.count;
    row->value[EVALUATION_SCENE_BYTES] = (double)scene.count * T3R_GAUSSIAN_BYTES;
    int code = reconstruction_load(&loaded, &scene, views->width, views->height, options);
    scene_file_free(&scene);
    if (code == CLI_OK) {
        row->value[EVALUATION_ARENA_BYTES] = (double)loaded.arena_bytes;
        code = evaluation_score(row, render, views, what, &loaded);
        reconstruction_close(&loaded);
    }
    return code;
}

int evaluation_measure(evaluation_row *row, uint8_t *render, evaluation_views *views, const evaluation_case *what,
                       evaluation_budget budget, bool from_file, const reconstruction_options *settings)
{
    reconstruction_options options = *settings;
    options.gaussians = budget.gaussians;
    options.keep_percent = budget.keep;
    options.hash = false; /* timed without hashing */
    options.context_count = what->context_count;
    memcpy(options.context, what->context, sizeof options.context);

    reconstruction built, loaded = {0};
    reconstruction_account account;
    int code = evaluation_name_row(row, what, budget, settings);
    if (code == CLI_OK && options.scene != NULL) {
        return measure_scene(row, render, views, what, &options);
    }
    if (code == CLI_OK) {
        code = options.method->build(&views->source, what->recording, what->path, &options, &built, &account);
    }
    if (code != CLI_OK) {
        return code;
    }
    reconstruction_warn_of_budget(&options, account.requested, built.scene.count);
    row->value[EVALUATION_GAUSSIANS] = built.scene.count;
    row->value[EVALUATION_LOSS] = built.loss.builds > 0 ? built.loss.loss : NAN;
    row->value[EVALUATION_BUILD_MS] = account.seconds * 1000;
    row->value[EVALUATION_ARENA_BYTES] = (double)account.arena_bytes;
    row->value[EVALUATION_SCENE_BYTES] = (double)built.scene.count * T3R_GAUSSIAN_BYTES;
    if (from_file) {
        code = through_file(&loaded, &built, views, &options);
    }
    if (code == CLI_OK) {
        code = evaluation_score(row, render, views, what, from_file ? &loaded : &built);
    }
    reconstruction_close(&loaded);
    reconstruction_close(&built);
    return code;
}
