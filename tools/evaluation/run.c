/* SPDX-License-Identifier: Apache-2.0 */
#include "evaluation/run.h"

#include <math.h>

#include "cli/cli.h"
#include "evaluation/cases.h"
#include "evaluation/work.h"
#include "reconstruction/scene_frames.h"

static int open_cases(const evaluation_options *o, evaluation_cases *cases)
{
    if (o->planar) {
        return evaluation_cases_of_images(cases, o->inputs, o->input_count, o->width, o->height);
    }
    return evaluation_cases_of_recordings(cases, o->inputs, o->input_count, &o->settings, o->target);
}

/* Opens the scene to be pruned, so that a bad one is reported before the work. */
static int look_at_scene(const char *path, int flags, const evaluation_cases *cases)
{
    if (cases->count > 1) {
        return cli_error(CLI_BAD_USAGE, "--prune: the scene belongs to one context; name it, of one recording, by "
                                        "--context and --target");
    }
    scene_file scene;
    int code = scene_to_prune(path, flags, &scene);
    if (code == CLI_OK) {
        scene_file_free(&scene);
    }
    return code;
}

static int report_all(const evaluation_options *o, const evaluation_work *work)
{
    evaluation_outputs to = o->to;
    to.planar = o->planar;
    to.wide = o->to.wide || work->contestants->count > 1; /* rows of a budget differ in columns of the wide table */
    to.folder_each = !o->planar && o->input_count > 1;
    int code = evaluation_settings_suffix(&o->settings, o->head_count == 0, to.suffix);
    if (code != CLI_OK) {
        return code;
    }
    evaluation_report report;
    code = evaluation_report_open(&report, &to, work->cases->count, evaluation_work_rows_each(work));
    code = code == CLI_OK ? evaluation_work_do(work, &report) : code;
    return evaluation_report_close(&report, code);
}

/* Opens the scene to be scored, for the same reason. */
static int look_at_judged(const char *path, int flags)
{
    scene_file scene;
    char error[512] = "";
    if (scene_file_read(path, flags, &scene, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    scene_file_free(&scene);
    return CLI_OK;
}

/* Lists percents first, then counts; a given scene file has a row, too. */
static uint32_t list_budgets(const evaluation_options *o, evaluation_budget budgets[2 * EVALUATION_BUDGETS_MOST])
{
    for (uint32_t i = 0; i < o->keep_count; i++) {
        budgets[i] = (evaluation_budget){.keep = o->keep[i]};
    }
    for (uint32_t i = 0; i < o->gaussians_count; i++) {
        budgets[o->keep_count + i] = (evaluation_budget){.gaussians = o->gaussians[i]};
    }
    if (o->settings.scene != NULL) {
        budgets[0] = (evaluation_budget){.keep = NAN};
        return 1;
    }
    return o->keep_count + o->gaussians_count;
}

int evaluation_run(const evaluation_options *o, const evaluation_contestants *contestants)
{
    evaluation_budget budgets[2 * EVALUATION_BUDGETS_MOST];
    evaluation_cases cases = {0};
    evaluation_resume resume = {0};
    int code = open_cases(o, &cases);
    if (code == CLI_OK && o->settings.points_of != NULL) {
        code = look_at_scene(o->settings.points_of, o->settings.scene_flags, &cases);
    }
    if (code == CLI_OK && o->settings.scene != NULL) {
        code = look_at_judged(o->settings.scene, o->settings.scene_flags);
    }
    if (code == CLI_OK && o->to.resume) {
        const char *made = o->settings.scene != NULL ? o->settings.scene : o->settings.points_of;
        code = evaluation_resume_open(&resume, o->to.csv, o->inputs, o->input_count, made, o->to.images != NULL);
    }
    if (code == CLI_OK) {
        evaluation_work work = {
            .cases = &cases,
            .contestants = contestants,
            .settings = &o->settings,
            .budgets = budgets,
            .budget_count = list_budgets(o, budgets),
            .from_file = o->from_file,
            .processes = o->processes,
            .resume = &resume,
        };
        code = report_all(o, &work);
    }
    evaluation_resume_close(&resume);
    evaluation_cases_close(&cases);
    return code;
}
