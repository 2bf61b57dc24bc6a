/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/rival.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/fixed.h"
#include "reconstruction/context_points.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/scene_frames.h"
#include "study/rivals/choose.h"
#include "study/rivals/score.h"
#include "study/rivals/traced.h"

#define FINETUNE_ITERATIONS 200u /* default of --finetune-iterations */

/* ---- shared --------------------------------------------------------------------------------------------------- */

static void close_source(void *made)
{
    rival_source *source = made;
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        free(source->rgb[v]);
        splat_view_close(&source->views[v]);
    }
    for (uint32_t k = 0; k < METHOD_KIND_COUNT; k++) {
        free(source->score[k]);
    }
    splat_model_free(&source->model);
    reconstruction_close(&source->whole);
    free(source);
}

/* Returns a new source, or NULL if out of memory. */
static rival_source *open_source(method_source *shared, const t3r_recording *recording, const char *path,
                                 const reconstruction_options *options)
{
    rival_source *source = shared->made;
    if (source == NULL && (source = calloc(1, sizeof *source)) != NULL) {
        *shared = (method_source){source, close_source};
        source->recording = recording;
        source->path = path;
        source->options = *options;
        if (options->mask_head != NULL) {
            source->options.head = options->mask_head;
        }
    }
    return source;
}

/* Opens the context views as pictures: the frames and size that a build resolved, with its aligned poses. */
static int open_pictures(rival_source *source, const reconstruction *r)
{
    reconstruction_options *o = &source->options;
    int code = CLI_OK;
    o->config.width = r->config.width;
    o->config.height = r->config.height;
    o->context_count = r->context_count;
    memcpy(o->context, r->context, sizeof o->context);
    for (uint32_t v = 0; v < o->context_count && code == CLI_OK; v++) {
        source->rgb[v] = malloc((size_t)o->config.width * o->config.height * 3);
        code = source->rgb[v] == NULL ? cli_error(CLI_BAD_INPUT, "out of memory")
                                      : developed_frame(source->recording, source->path, o->context[v], o->config.width,
                                                        o->config.height, source->rgb[v], NULL, &source->camera[v]);
        t3r_camera aligned; /* a scene from a file has no aligned views: the given poses are used */
        if (code == CLI_OK && t3r_view_camera(r->runtime, v, &aligned) == T3R_OK) {
            source->camera[v] = aligned;
        }
    }
    source->opened = code == CLI_OK;
    return code;
}

static bool open_views(rival_source *source)
{
    const t3r_scene *scene = &source->whole.scene;
    bool done = splat_model_of(&source->model, scene->gaussians, scene->count);
    for (; done && source->view_count < source->options.context_count; source->view_count++) {
        splat_view *view = &source->views[source->view_count];
        splat_camera camera = splat_camera_of(&source->camera[source->view_count], &scene->frame,
                                              source->options.config.width, source->options.config.height);
        done = splat_view_open(view, &camera, scene->count) && splat_view_project(view, &source->model);
    }
    return done;
}

/* Loads a scene from a file in place of an unpruned one. */
static int load_whole(rival_source *source)
{
    scene_file scene;
    double start = cli_now();
    int code = scene_to_prune(source->options.points_of, source->options.scene_flags, &scene);
    if (code != CLI_OK) {
        return code;
    }
    reconstruction *whole = &source->whole;
    reconstruction_options plain = source->options;
    plain.arena = ARENA_FULL;
    plain.hash = false;
    code = reconstruction_load(whole, &scene, T3R_MIN_SIDE, T3R_MIN_SIDE, &plain);
    if (code == CLI_OK) {
        code = reconstruction_views(whole, source->recording, source->path, &source->options);
    }
    whole->valid_points = whole->scene.count;
    whole->build_seconds = cli_now() - start;
    return code;
}

/* Builds the unpruned scene, converts it to floats, and opens its context views. */
static int build_whole(rival_source *source)
{
    reconstruction_options options = source->options;
    options.gaussians = 0;
    options.keep_percent = 100;
    int code = options.points_of != NULL
                   ? load_whole(source)
                   : reconstruction_build(&source->whole, source->recording, source->path, &options);
    if (code == CLI_OK && !source->opened) {
        code = open_pictures(source, &source->whole);
    }
    if (code != CLI_OK) {
        return code;
    }
    double start = cli_now();
    if (!open_views(source)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    source->project_seconds = cli_now() - start;
    source->built = true;
    return CLI_OK;
}

static int make_score(rival_source *source, method_kind kind)
{
    if (source->score[kind] != NULL) {
        return CLI_OK;
    }
    double start = cli_now();
    source->score[kind] = malloc(((size_t)source->model.count + 1) * sizeof(double));
    if (source->score[kind] == NULL || !score_of(kind, &source->model, source->views, source->view_count,
                                                 source->options.config.seed, source->score[kind])) {
        free(source->score[kind]);
        source->score[kind] = NULL;
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    source->score_seconds[kind] = cli_now() - start;
    return CLI_OK;
}

/* ---- pruning -------------------------------------------------------------------------------------------------- */

/* Allocates `count` Gaussians, with harmonics of the unpruned scene's degree. */
static bool open_scene(const reconstruction *whole, uint32_t count, scene_file *scene)
{
    *scene = (scene_file){.frame = whole->scene.frame, .count = count, .degree = whole->loaded.degree};
    scene->gaussians = malloc(((size_t)count + 1) * sizeof *scene->gaussians);
    if (scene->degree > 0) {
        scene->harmonics_q12 = malloc(((size_t)count + 1) * scene_file_harmonics_count(scene) * sizeof(int16_t));
    }
    return scene->gaussians != NULL && (scene->degree == 0 || scene->harmonics_q12 != NULL);
}

/* Copies the `count` best Gaussians of the unpruned scene, unchanged. */
static int prune(rival_source *source, method_kind kind, uint32_t count, scene_file *scene)
{
    const reconstruction *whole = &source->whole;
    uint32_t *kept = malloc(((size_t)count + 1) * sizeof *kept);
    int code = open_scene(whole, count, scene) && kept != NULL &&
                       rival_choose(source->score[kind], whole->scene.count, count, kept)
                   ? CLI_OK
                   : cli_error(CLI_BAD_INPUT, "out of memory");
    for (uint32_t n = 0; n < count && code == CLI_OK; n++) {
        scene->gaussians[n] = whole->scene.gaussians[kept[n]];
        if (scene->degree > 0) {
            memcpy(scene_file_harmonics(scene, n), scene_file_harmonics(&whole->loaded, kept[n]),
                   scene_file_harmonics_count(scene) * sizeof(int16_t));
        }
    }
    free(kept);
    return code;
}

/* Makes the unpruned scene and its scores. *account covers everything up to here, for the budget of `options`. */
static int rank_whole(rival_source *source, method_kind kind, const reconstruction_options *options,
                      reconstruction_account *account)
{
    int code = source->built ? CLI_OK : build_whole(source);
    if (code == CLI_OK) {
        code = make_score(source, kind);
    }
    if (code != CLI_OK) {
        return code;
    }
    *account = reconstruction_account_of(&source->whole);
    account->requested = options->gaussians != 0 ? options->gaussians
                                                 : reconstruction_budget(account->valid_points, options->keep_percent);
    account->seconds += source->project_seconds + source->score_seconds[kind];
    return CLI_OK;
}

static int prune_whole(rival_source *source, method_kind kind, const reconstruction_options *options, scene_file *scene,
                       reconstruction_account *account)
{
    int code = rank_whole(source, kind, options, account);
    if (code != CLI_OK) {
        return code;
    }
    double start = cli_now();
    code = prune(source, kind, T3R_MIN(account->requested, source->whole.scene.count), scene);
    account->seconds += cli_now() - start;
    return code;
}

/* ---- ours, to be fine-tuned ------------------------------------------------------------------------------------- */

static int build_ours(rival_source *source, const reconstruction_options *options, scene_file *scene,
                      reconstruction_account *account)
{
    reconstruction r;
    int code = reconstruction_build(&r, source->recording, source->path, options);
    if (code != CLI_OK) {
        return code;
    }
    *account = reconstruction_account_of(&r);
    *scene = (scene_file){.frame = r.scene.frame, .count = r.scene.count};
    scene->gaussians = malloc(((size_t)r.scene.count + 1) * sizeof *scene->gaussians);
    if (scene->gaussians == NULL) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    } else {
        memcpy(scene->gaussians, r.scene.gaussians, r.scene.count * sizeof *scene->gaussians);
        code = source->opened ? CLI_OK : open_pictures(source, &r);
    }
    reconstruction_close(&r);
    return code;
}

/* ---- our head on their points ----------------------------------------------------------------------------------- */

/* Finds the points that the `count` best Gaussians of the unpruned scene came from. */
static int trace_chosen(const rival_source *source, method_kind kind, uint32_t count, traced_points *points)
{
    reconstruction_options all = source->options;
    all.gaussians = 0;
    all.keep_percent = 100;
    *points = (traced_points){0};
    uint32_t *kept = malloc(((size_t)count + 1) * sizeof *kept);
    int code = kept != NULL && rival_choose(source->score[kind], source->whole.scene.count, count, kept)
                   ? traced_points_make(points, source->recording, source->path, &all, kept, count)
                   : cli_error(CLI_BAD_INPUT, "out of memory");
    free(kept);
    return code;
}

static int build_by_head(rival_source *source, method_kind kind, const reconstruction_options *options,
                         reconstruction *made, reconstruction_account *account)
{
    traced_points points = {0};
    reconstruction_account before = {0};
    int code;
    if (kind == METHOD_TRIM3R) {
        code = traced_points_make(&points, source->recording, source->path, options, NULL, 0);
    } else {
        code = rank_whole(source, kind, options, &before);
        if (code == CLI_OK) {
            code = trace_chosen(source, kind, T3R_MIN(before.requested, source->whole.scene.count), &points);
        }
    }
    if (code == CLI_OK) {
        reconstruction_options given = *options;
        given.config.allocate = T3R_ALLOCATE_GIVEN;
        given.importance = NULL;
        given.importance_planes = (const uint16_t *const *)points.planes;
        code = reconstruction_build(made, source->recording, source->path, &given);
    }
    if (code == CLI_OK) {
        *account = reconstruction_account_of(made);
        account->arena_bytes = T3R_MAX(account->arena_bytes, before.arena_bytes);
        account->seconds += before.seconds;
    }
    traced_points_free(&points);
    return code;
}

/* ---- fine-tuning ------------------------------------------------------------------------------------------------ */

/* Fine-tunes colours of degree 0, without the harmonics of a scene from a file. */
static int tune(const rival_source *source, uint32_t iterations, scene_file *scene)
{
    scene->degree = 0;
    finetune_target targets[T3R_MAX_VIEWS];
    uint32_t views = source->options.context_count;
    for (uint32_t v = 0; v < views; v++) {
        targets[v].camera = splat_camera_of(&source->camera[v], &scene->frame, source->options.config.width,
                                            source->options.config.height);
        targets[v].rgb = source->rgb[v];
    }
    splat_model model;
    bool done = splat_model_of(&model, scene->gaussians, scene->count) &&
                finetune(&model, targets, views, iterations, &finetune_rates_default);
    cli_progress_end();
    for (uint32_t i = 0; i < scene->count && done; i++) {
        splat_model_store(&model.parameters[(size_t)i * SPLAT_PARAMETERS], &scene->gaussians[i]);
    }
    splat_model_free(&model);
    return done ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
}

int rival_build(method_source *shared, const t3r_recording *recording, const char *path,
                const reconstruction_options *options, reconstruction *made, reconstruction_account *account)
{
    const method *m = options->method;
    if (reconstruction_chooses(options)) {
        return cli_error(CLI_BAD_USAGE, "%s chooses for the method trim3r alone, not for %s",
                         options->automatic ? "--auto" : "--min-psnr", m->name);
    }
    rival_source *source = open_source(shared, recording, path, options);
    if (source == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    const method_kind kind = method_kind_of(m);
    if (method_way_of(m) == METHOD_HEAD) {
        return build_by_head(source, kind, options, made, account);
    }
    scene_file scene = {0};
    int code = kind == METHOD_TRIM3R ? build_ours(source, options, &scene, account)
                                     : prune_whole(source, kind, options, &scene, account);
    if (code == CLI_OK && method_way_of(m) == METHOD_FINETUNE) {
        double start = cli_now();
        const uint32_t iterations = options->finetune_iterations;
        code = tune(source, iterations != 0 ? iterations : FINETUNE_ITERATIONS, &scene);
        account->seconds += cli_now() - start;
    }
    if (code == CLI_OK) {
        uint32_t width =
            options->config.render_width != 0 ? options->config.render_width : source->options.config.width;
        uint32_t height =
            options->config.render_height != 0 ? options->config.render_height : source->options.config.height;
        reconstruction_options plain = *options;
        plain.arena = ARENA_FULL;
        plain.hash = false;
        code = reconstruction_load(made, &scene, width, height, &plain);
    }
    scene_file_free(&scene);
    return code;
}
