/* SPDX-License-Identifier: Apache-2.0 */
#include "study/stress/run.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "reconstruction/context_points.h"
#include "study/stress/random.h"

int stress_case_open(stress_case *c, const stress_contest *contest)
{
    stress_run run;
    reconstruction_points points = {.valid = 0};
    c->views = (evaluation_views){0};
    int code = stress_run_open(&run, c, contest, NULL, 0, 0);
    const reconstruction_options settings = stress_run_options(&run, c, contest, contest->keep_count);
    if (code == CLI_OK) {
        code = reconstruction_count(&points, run.recording, c->name, &settings);
    }
    if (code == CLI_OK) {
        code = evaluation_views_make(&c->views, &run.what, &settings);
    }
    stress_run_close(&run);
    for (uint32_t k = 0; k < contest->keep_count; k++) {
        c->budget[k] = reconstruction_budget(points.valid, contest->keep[k]);
    }
    return code;
}

void stress_case_close(stress_case *c)
{
    evaluation_views_free(&c->views);
}

/* Applies the changes of capture `index`: the perturbation, with the same or a new draw, and a sensor's noise. */
static bool change(stress_capture *capture, const stress_contest *contest, const perturbation *p, double strength,
                   uint32_t index)
{
    uint32_t seed = stress_random(contest->seed, 0);
    for (const char *name = p == NULL ? "" : p->name; *name != '\0'; name++) {
        seed = stress_random(seed, (uint8_t)*name);
    }
    bool done = p == NULL || p->apply(capture, strength, p->each_frame ? stress_random(seed, index) : seed);
    if (done && index > 0) {
        stress_still_noise(capture, stress_random(contest->seed, index));
    }
    return done;
}

int stress_run_open(stress_run *run, const stress_case *c, const stress_contest *contest, const perturbation *p,
                    double strength, uint32_t capture)
{
    *run = (stress_run){.views = c->views};
    run->views.context_count = 0; /* context_psnr is not needed */
    run->views.source = (method_source){0};
    if (!stress_capture_copy(&run->capture, &c->base) || !change(&run->capture, contest, p, strength, capture)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    run->recording = stress_capture_recording(&run->capture, &run->bytes);
    if (run->recording == NULL) {
        return CLI_BAD_INPUT;
    }
    run->what = (evaluation_case){.recording = run->recording,
                                  .path = c->name,
                                  .scene = c->name,
                                  .context_count = c->base.views,
                                  .target = c->base.views};
    for (uint32_t v = 0; v < c->base.views; v++) {
        run->what.context[v] = v;
    }
    t3r_capture_frame target;
    int code = recorded_frame_read(run->recording, c->name, run->what.target, &target);
    if (code == CLI_OK) {
        run->views.target.camera = target.camera;
    }
    return code;
}

void stress_run_close(stress_run *run)
{
    method_source_close(&run->views.source);
    if (run->recording != NULL) {
        t3r_recording_close(run->recording);
    }
    free(run->bytes);
    stress_capture_free(&run->capture);
}

reconstruction_options stress_run_options(const stress_run *run, const stress_case *c, const stress_contest *contest,
                                          uint32_t keep)
{
    reconstruction_options options = contest->settings;
    options.gaussians = keep < contest->keep_count ? c->budget[keep] : 0;
    options.keep_percent = keep < contest->keep_count ? 0 : 100;
    options.automatic &= keep < contest->keep_count;
    options.min_psnr = keep < contest->keep_count ? options.min_psnr : 0;
    options.hash = false;
    options.config.width = c->base.width;
    options.config.height = c->base.height;
    options.context_count = run->what.context_count;
    memcpy(options.context, run->what.context, sizeof options.context);
    return options;
}

int stress_run_build(stress_run *run, const reconstruction_options *options, reconstruction *built,
                     reconstruction_account *account)
{
    return options->method->build(&run->views.source, run->recording, run->what.path, options, built, account);
}
