/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/rival.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/fixed.h"
#include "study/rivals/scores/choose.h"
#include "study/rivals/source.h"
#include "study/rivals/traced.h"
#include "study/rivals/tuned_scene.h"

/* ---- pruning -------------------------------------------------------------------------------------------------- */

/* Sets source->kept to the indices of the `count` best Gaussians of the unpruned scene. */
static int choose(rival_source *source, method_kind kind, uint32_t count)
{
    free(source->kept);
    source->kept = malloc(((size_t)count + 1) * sizeof *source->kept);
    return source->kept != NULL && rival_choose(source->score[kind], source->model.surfaces, source->whole.scene.count,
                                                count, source->kept)
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "out of memory");
}

/* Copies the `count` best Gaussians of the unpruned scene, unchanged. */
static int prune(rival_source *source, method_kind kind, uint32_t count, scene_file *scene)
{
    const reconstruction *whole = &source->whole;
    int code = choose(source, kind, count);
    if (code == CLI_OK && !rival_scene_open(whole, count, whole->loaded.degree, scene)) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t n = 0; n < count && code == CLI_OK; n++) {
        scene->gaussians[n] = whole->scene.gaussians[source->kept[n]];
        if (scene->degree > 0) {
            memcpy(scene_file_harmonics(scene, n), scene_file_harmonics(&whole->loaded, source->kept[n]),
                   scene_file_harmonics_count(scene) * sizeof(int16_t));
        }
    }
    return code;
}

static int prune_whole(rival_source *source, method_kind kind, const reconstruction_options *options, scene_file *scene,
                       reconstruction_account *account)
{
    int code = rival_source_rank(source, kind, options, account);
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
static int trace_chosen(rival_source *source, method_kind kind, uint32_t count, traced_points *points)
{
    reconstruction_options all = source->options;
    all.gaussians = 0;
    all.keep_percent = 100;
    *points = (traced_points){0};
    int code = choose(source, kind, count);
    return code == CLI_OK ? traced_points_make(points, source->recording, source->path, &all, source->kept, count)
                          : code;
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
        code = rival_source_rank(source, kind, options, &before);
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

/* ---- a method ---------------------------------------------------------------------------------------------------- */

static int make_scene(rival_source *source, const method *m, const reconstruction_options *options, scene_file *scene,
                      reconstruction_account *account)
{
    const method_kind kind = method_kind_of(m);
    if (method_way_of(m) == METHOD_PLAIN) {
        return prune_whole(source, kind, options, scene, account);
    }
    return kind == METHOD_TRIM3R ? tuned_scene_of_ours(source, options, scene, account)
                                 : tuned_scene_of_rival(source, kind, options, scene, account);
}

int rival_build(method_source *shared, const t3r_recording *recording, const char *path,
                const reconstruction_options *options, reconstruction *made, reconstruction_account *account)
{
    const method *m = options->method;
    if (reconstruction_chooses(options)) {
        return cli_error(CLI_BAD_USAGE, "%s chooses for the method trim3r alone, not for %s",
                         options->automatic ? "--auto" : "--min-psnr", m->name);
    }
    rival_source *source = rival_source_open(shared, recording, path, options);
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
