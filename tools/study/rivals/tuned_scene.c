/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/tuned_scene.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/fixed.h"
#include "study/rivals/tuning/tune.h"

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
        t->targets[v].camera =
            splat_camera_of(&source->camera[v], frame, source->options.config.width, source->options.config.height);
        t->targets[v].rgb = source->rgb[v];
    }
    return t->threads != NULL
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "the system refuses %" PRIu32 " threads", options->processor.threads);
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

int tuned_scene_of_rival(rival_source *source, method_kind kind, const reconstruction_options *options,
                         scene_file *scene, reconstruction_account *account)
{
    tuning t;
    tuned_model tuned = {0};
    int code = rival_source_rank(source, kind, options, account);
    code = code == CLI_OK ? begin_tuning(&t, source, &source->whole.scene.frame, options) : code;
    if (code != CLI_OK) {
        return code;
    }
    const double start = cli_now();
    const uint32_t budget = T3R_MIN(account->requested, source->whole.scene.count);
    code = end_tuning(&t, tuned_model_of(&tuned, &source->model) &&
                              tune_rival(&tuned, kind, source->score[kind], budget, options->config.seed, t.targets,
                                         t.count, &options->finetune, t.threads));
    if (code == CLI_OK && !rival_scene_open(&source->whole, budget, 0, scene)) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    }
    for (uint32_t n = 0; n < budget && code == CLI_OK; n++) {
        scene->gaussians[n] = source->whole.scene.gaussians[tuned.of[n]];
    }
    if (code == CLI_OK) {
        store_model(&tuned.model, scene);
        free(source->kept);
        source->kept = tuned.of;
        tuned.of = NULL;
    }
    tuned_model_free(&tuned);
    account->seconds += cli_now() - start;
    return code;
}

/* Copies the scene of a build of ours. */
static int copy_scene(const reconstruction *r, scene_file *scene)
{
    if (!rival_scene_open(r, r->scene.count, 0, scene)) {
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

int tuned_scene_of_ours(rival_source *source, const reconstruction_options *options, scene_file *scene,
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
        code = rival_source_pictures(source, &r);
    }
    reconstruction_close(&r);
    const double start = cli_now();
    code = code == CLI_OK ? tune_scene(source, options, scene) : code;
    account->seconds += cli_now() - start;
    return code;
}
