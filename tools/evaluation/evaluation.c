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
#include "pictures/metrics.h"
#include "reconstruction/context/corrected_views.h"
#include "reconstruction/reconstruction_error.h"
#include "scene/scene_file.h"

/* alpha_q15 is one minus transmittance; 32767 is the runtime's one */
#define ALPHA_ONE 32767u
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

/* Draws a picture's view as its camera would have seen it. *milliseconds: those of the drawing alone. */
static int draw_corrected(reconstruction *r, const corrected_views *corrected, const evaluation_picture *picture,
                          const evaluation_views *views, uint8_t *rgb, uint16_t *alpha, double *milliseconds)
{
    double gain[3];
    const t3r_camera camera = corrected_views_camera(corrected, &picture->camera, gain);
    const double start = cli_now();
    const int code = evaluation_draw(r, &camera, views, rgb, alpha);
    *milliseconds = (cli_now() - start) * 1000;
    if (code == CLI_OK) {
        corrected_views_expose(rgb, (size_t)views->width * views->height, gain);
    }
    return code;
}

/* Draws the target from the scene in `r`, and scores it. */
static int score_target(evaluation_row *row, uint8_t *render, uint16_t *alpha, const evaluation_views *views,
                        bool planar, reconstruction *r, const corrected_views *corrected)
{
    const uint32_t w = views->width, h = views->height;
    const evaluation_picture *target = &views->target;
    const int code = draw_corrected(r, corrected, target, views, render, alpha, &row->value[EVALUATION_RENDER_MS]);
    if (code != CLI_OK) {
        return code;
    }
    const double psnr = metric_psnr(target->rgb, render, target->mask, w, h);
    row->value[EVALUATION_PSNR_ALL] = metric_psnr(target->rgb, render, target->shown, w, h);
    row->value[EVALUATION_SSIM_ALL] = metric_ssim(target->rgb, render, target->shown, w, h);
    row->value[EVALUATION_PERCEPTUAL_ALL] = metric_flip(target->rgb, render, target->shown, w, h);
    row->value[planar ? EVALUATION_PLANAR_PSNR : EVALUATION_PSNR] = psnr;
    row->value[EVALUATION_PSNR_SEEN] = views->sensed ? psnr : NAN;
    row->value[EVALUATION_SSIM] = metric_ssim(target->rgb, render, target->mask, w, h);
    row->value[EVALUATION_SHARP] = metric_sharp(target->rgb, render, target->mask, w, h);
    row->value[EVALUATION_PERCEPTUAL] = metric_flip(target->rgb, render, target->mask, w, h);
    row->value[EVALUATION_HOLES] = share_of_holes(alpha, target->mask, (size_t)w * h);
    return CLI_OK;
}

/* Draws the context views, and sets the mean of their PSNR. */
static int score_context(evaluation_row *row, uint8_t *rgb, const evaluation_views *views, reconstruction *r,
                         const corrected_views *corrected)
{
    double sum = 0, milliseconds;
    for (uint32_t v = 0; v < views->context_count; v++) {
        const evaluation_picture *context = &views->context[v];
        const int code = draw_corrected(r, corrected, context, views, rgb, NULL, &milliseconds);
        if (code != CLI_OK) {
            return code;
        }
        sum += metric_psnr(context->rgb, rgb, context->mask, views->width, views->height);
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
                     reconstruction *r, const reconstruction_account *account)
{
    corrected_views corrected = {0};
    if (account != NULL) {
        const int code = corrected_views_of(what->recording, what->path, account, &corrected);
        if (code != CLI_OK) {
            return code;
        }
    }
    size_t pixels = (size_t)views->width * views->height;
    uint8_t *rgb = malloc(pixels * 3);
    uint16_t *alpha = malloc(pixels * sizeof *alpha);
    int code = rgb == NULL || alpha == NULL ? cli_error(CLI_BAD_INPUT, "out of memory")
                                            : score_target(row, render, alpha, views, what->planar, r, &corrected);
    if (code == CLI_OK && !what->planar) {
        code = score_context(row, rgb, views, r, &corrected);
    }
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
        code = evaluation_score(row, render, views, what, &loaded, NULL);
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
        code = evaluation_score(row, render, views, what, from_file ? &loaded : &built, &account);
    }
    reconstruction_close(&loaded);
    reconstruction_close(&built);
    return code;
}
