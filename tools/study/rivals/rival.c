/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/rival.h"

#include <inttypes.h>
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
#include "study/rivals/tune.h"

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

/* Allocates `count` Gaussians in the frame of the scene in `r`, with harmonics of that degree. */
static bool open_scene(const reconstruction *r, uint32_t count, uint32_t degree, scene_file *scene)
{
    *scene = (scene_file){.frame = r->scene.frame, .count = count, .degree = degree};
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
    int code = open_scene(whole, count, whole->loaded.degree, scene) && kept != NULL &&
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

/* The views that fine-tuning compares with, in the frame of a scene. */
typedef struct tuning {
    finetune_target targets[T3R_MAX_VIEWS];
    uint32_t count;
    t3r_threads *threads;
} tuning;

static int begin_tuning(tuning *t, const rival_source *source, const t3r_scene_frame *frame,
                        const reconstruction_options *options)
{
    *t = (tuning){.count = source->options.context_count, .threads = t3r_threads_start(options->processor.threads)};
    for (uint32_t v = 0; v < t->count; v++) {
        t->targets[v].camera = splat_camera_of(&source->camera[v], frame, source->options.config.width,
                                               source->options.config.height);
        t->targets[v].rgb = source->rgb[v];
    }
    return t->threads != NULL ? CLI_OK
                              : cli_error(CLI_BAD_INPUT, "the system refuses %" PRIu32 " threads",
                                          options->processor.threads);
}

static int end_tuning(tuning *t, bool done)
{
    t3r_threads_stop(t->threads);
    cli_progress_end();
    return done ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
}

/* Stores the Gaussians of a model, which began as scene->gaussians. */
static void store_model(const splat_model *model, scene_file *scene)
{
    for (uint32_t i = 0; i < scene->count; i++) {
        splat_model_store(&model->parameters[(size_t)i * SPLAT_PARAMETERS], &scene->gaussians[i]);
    }
}

/* Makes a rival's scene. It has colours of degree 0, without the harmonics of a scene from a file. */
static int tune_whole(rival_source *source, method_kind kind, const reconstruction_options *options, scene_file *scene,
                      reconstruction_account *account)
{
    tuning t;
    tuned_model tuned = {0};
    int code = rank_whole(source, kind, options, account);
    code = code == CLI_OK ? begin_tuning(&t, source, &source->whole.scene.frame, options) : code;
    if (code != CLI_OK) {
        return code;
    }
    const double start = cli_now();
    const uint32_t budget = T3R_MIN(account->requested, source->whole.scene.count);
    code = end_tuning(&t, tuned_model_of(&tuned, &source->model) &&
                              tune_rival(&tuned, kind, source->score[kind], budget, options->config.seed, t.targets,
                                         t.count, &options->finetune, t.threads));
    if (code == CLI_OK && !open_scene(&source->whole, budget, 0, scene)) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t n = 0; n < budget && code == CLI_OK; n++) {
        scene->gaussians[n] = source->whole.scene.gaussians[tuned.of[n]];
    }
    if (code == CLI_OK) {
        store_model(&tuned.model, scene);
    }
    tuned_model_free(&tuned);
    account->seconds += cli_now() - start;
    return code;
}

/* Copies the scene of a build of ours. */
static int copy_scene(const reconstruction *r, scene_file *scene)
{
    if (!open_scene(r, r->scene.count, 0, scene)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    memcpy(scene->gaussians, r->scene.gaussians, r->scene.count * sizeof *scene->gaussians);
    return CLI_OK;
}

static int tune_scene(const rival_source *source, const reconstruction_options *options, scene_file *scene)
{
    tuning t;
    splat_model model = {0};
    int code = begin_tuning(&t, source, &scene->frame, options);
    if (code != CLI_OK) {
        return code;
    }
    code = end_tuning(&t, splat_model_of(&model, scene->gaussians, scene->count) &&
                              tune_model(&model, t.targets, t.count, &options->finetune, t.threads));
    if (code == CLI_OK) {
        store_model(&model, scene);
    }
    splat_model_free(&model);
    return code;
}

/* Builds a scene of ours and fine-tunes it as it is. */
static int tune_ours(rival_source *source, const reconstruction_options *options, scene_file *scene,
                     reconstruction_account *account)
{
    reconstruction r;
    int code = reconstruction_build(&r, source->recording, source->path, options);
    if (code != CLI_OK) {
        return code;
    }
    *account = reconstruction_account_of(&r);
    code = copy_scene(&r, scene);
    if (code == CLI_OK && !source->opened) {
        code = open_pictures(source, &r);
    }
    reconstruction_close(&r);
    const double start = cli_now();
    code = code == CLI_OK ? tune_scene(source, options, scene) : code;
    account->seconds += cli_now() - start;
    return code;
}

/* ---- a method ---------------------------------------------------------------------------------------------------- */

static int make_scene(rival_source *source, const method *m, const reconstruction_options *options, scene_file *scene,
                      reconstruction_account *account)
{
    const method_kind kind = method_kind_of(m);
    if (method_way_of(m) == METHOD_PLAIN) {
        return prune_whole(source, kind, options, scene, account);
    }
    return kind == METHOD_TRIM3R ? tune_ours(source, options, scene, account)
                                 : tune_whole(source, kind, options, scene, account);
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
    if (method_way_of(m) == METHOD_HEAD) {
        return build_by_head(source, method_kind_of(m), options, made, account);
    }
    scene_file scene = {0};
    int code = make_scene(source, m, options, &scene, account);
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
