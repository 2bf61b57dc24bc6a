/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/source.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "reconstruction/context_points.h"
#include "reconstruction/developed_frame.h"
#include "reconstruction/scene_frames.h"
#include "study/rivals/scores/score.h"

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
    free(source->kept);
    splat_model_free(&source->model);
    reconstruction_close(&source->whole);
    free(source);
}

rival_source *rival_source_open(method_source *shared, const t3r_recording *recording, const char *path,
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

int rival_source_pictures(rival_source *source, const reconstruction *r)
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
        code = rival_source_pictures(source, &source->whole);
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

int rival_source_rank(rival_source *source, method_kind kind, const reconstruction_options *options,
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

bool rival_scene_open(const reconstruction *r, uint32_t count, uint32_t degree, scene_file *scene)
{
    *scene = (scene_file){.frame = r->scene.frame, .count = count, .degree = degree};
    scene->gaussians = malloc(((size_t)count + 1) * sizeof *scene->gaussians);
    if (scene->degree > 0) {
        scene->harmonics_q12 = malloc(((size_t)count + 1) * scene_file_harmonics_count(scene) * sizeof(int16_t));
    }
    return scene->gaussians != NULL && (scene->degree == 0 || scene->harmonics_q12 != NULL);
}
