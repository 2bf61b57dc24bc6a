/* SPDX-License-Identifier: Apache-2.0 */
#include "planning/calibrate.h"

#include <inttypes.h>
#include <stdlib.h>

#include "cli/cli.h"
#include "planning/bench_views.h"
#include "planning/price_fit.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/stage_times.h"
#include "room/room.h"
#include "trim3r_host.h"

/* Configurations in which each kind of work dominates in one and matters little in another. */
static const struct {
    uint32_t width, height, views, percent; /* percent of the points kept */
    const char *head;
    uint32_t clusters, batches, passes;
    t3r_depth depth;
} settings[] = {
    {256, 256, 2, 10, "small", 300, 24, 1, T3R_DEPTH_SENSOR},
    {256, 256, 2, 2, "analytic", 300, 24, 2, T3R_DEPTH_SENSOR},
    {128, 128, 2, 20, "tiny", 100, 24, 1, T3R_DEPTH_SENSOR},
    {256, 256, 2, 5, "small", 64, 24, 0, T3R_DEPTH_SENSOR},
    {128, 128, 4, 10, "analytic", 300, 24, 2, T3R_DEPTH_SENSOR},
    {64, 64, 2, 100, "small", 300, 24, 1, T3R_DEPTH_SENSOR},
    {320, 240, 1, 2, "analytic", 512, 24, 2, T3R_DEPTH_SENSOR},
    {160, 160, 2, 100, "tiny", 50, 24, 1, T3R_DEPTH_SENSOR},
    {128, 128, 2, 10, "analytic", 300, 24, 0, T3R_DEPTH_STEREO},
    {192, 192, 2, 10, "analytic", 100, 24, 0, T3R_DEPTH_STEREO},
    {128, 128, 1, 50, "analytic", 200, 0, 1, T3R_DEPTH_SENSOR},
    {384, 288, 2, 5, "analytic", 300, 24, 1, T3R_DEPTH_SENSOR},
    {128, 128, 2, 100, "small", 200, 8, 0, T3R_DEPTH_SENSOR},
    {192, 192, 1, 10, "small", 100, 24, 1, T3R_DEPTH_SENSOR},
    {64, 64, 2, 2, "analytic", 100, 24, 4, T3R_DEPTH_SENSOR},
    {96, 96, 2, 1, "analytic", 100, 0, 2, T3R_DEPTH_SENSOR},
    {96, 96, 1, 30, "small", 64, 24, 4, T3R_DEPTH_SENSOR},
};
enum { TRIALS = sizeof settings / sizeof settings[0] };
_Static_assert(TRIALS <= PRICE_FIT_TIMES, "a fit holds the trials");

/* ---- one trial --------------------------------------------------------------------------------------------------- */

typedef struct trial {
    t3r_config config;
    chosen_head head;
    work_counts work;
    t3r_runtime *runtime;
    void *arena;
    bench_views views;
    uint8_t *picture;
    stage_clock clock; /* uses the calibration's threads */
    stage_times least; /* least times of all runs */
} trial;

static t3r_config config_of(uint32_t index, const processor_options *processor)
{
    const uint64_t points = (uint64_t)settings[index].width * settings[index].height * settings[index].views;
    t3r_config config = t3r_default_config(settings[index].width, settings[index].height, settings[index].views,
                                           (uint32_t)(points * settings[index].percent / 100));
    config.clusters = settings[index].clusters;
    config.cluster_batches = settings[index].batches;
    config.refine = settings[index].passes;
    config.fit_passes = 0;
    config.depth = settings[index].depth;
    config.workers = processor->threads;
    return config;
}

static t3r_status open_runtime(trial *t, const processor_options *processor)
{
    t3r_plan_info plan;
    t3r_status status = t3r_plan(&t->config, &plan);
    if (status != T3R_OK || posix_memalign(&t->arena, T3R_ARENA_ALIGN, plan.bytes) != 0) {
        t->arena = NULL;
        return status != T3R_OK ? status : T3R_ERR_ARENA;
    }
    const t3r_hooks hooks = stage_clock_hooks(&t->clock);
    status = t3r_init(&t->runtime, t->arena, plan.bytes, &t->config);
    if (status == T3R_OK) {
        (void)t3r_set_cpu(t->runtime, processor->cpu);
        (void)t3r_set_hooks(t->runtime, &hooks);
        status = chosen_head_bind(&t->head, t->runtime, (t3r_ablation){0});
    }
    return status == T3R_OK ? work_count(&t->config, plan.bytes, t->head.weights, &t->work) : status;
}

static int room_error(t3r_status status)
{
    return status == T3R_OK ? CLI_OK : cli_error(CLI_BAD_INPUT, "the built-in room: %s", t3r_error_text(status));
}

static int open_trial(trial *t, uint32_t index, const processor_options *processor)
{
    t->config = config_of(index, processor);
    const int code = chosen_head_open(&t->head, settings[index].head);
    if (code != CLI_OK) {
        return code;
    }
    chosen_head_configure(&t->head, &t->config);
    t->picture = malloc((size_t)t->config.width * t->config.height * 3);
    if (t->picture == NULL || !bench_views_draw(&t->views, t->config.width, t->config.height, t->config.views)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    return room_error(open_runtime(t, processor));
}

static void close_trial(trial *t)
{
    bench_views_free(&t->views);
    free(t->picture);
    free(t->arena);
    chosen_head_close(&t->head);
}

/* Builds, and draws a view between the first two of its own. */
static t3r_status build_and_draw(trial *t)
{
    const uint32_t width = t->config.width, height = t->config.height;
    const t3r_target target = {.width = width, .height = height, .rgb = t->picture, .rgb_stride_bytes = 3 * width};
    t3r_camera camera;
    t3r_scene scene;
    t3r_status status = bench_views_add(&t->views, t->runtime);
    status = status == T3R_OK ? t3r_reconstruct(t->runtime, NULL, &scene) : status;
    room_camera(1, width, height, &camera);
    return status == T3R_OK ? t3r_render(t->runtime, &camera, &target) : status;
}

static int run_trial(trial *t)
{
    stage_times_begin(&t->clock.times, t->config.workers);
    const t3r_status status = build_and_draw(t);
    stage_times_keep_least(&t->least, &t->clock.times);
    return room_error(status);
}

/* ---- prices ------------------------------------------------------------------------------------------------------ */

static uint32_t rounded(double price)
{
    return price >= UINT32_MAX ? UINT32_MAX : (uint32_t)(price + 0.5);
}

/* Fits the prices of a stage's kinds of work. Returns the largest error. */
static double fit_stage(const trial *trials, t3r_stage stage, work_prices *prices)
{
    price_fit fit = {0};
    work_kind kinds[PRICE_FIT_KINDS];
    double found[PRICE_FIT_KINDS];
    for (int work = 0; work < WORK_KIND_COUNT; work++) {
        if (work_stage((work_kind)work) == stage) {
            kinds[fit.kinds++] = (work_kind)work;
        }
    }
    for (uint32_t i = 0; i < TRIALS; i++) {
        if (trials[i].least.seconds[stage] <= 0) {
            continue;
        }
        for (uint32_t k = 0; k < fit.kinds; k++) {
            fit.units[fit.times][k] = (double)trials[i].work.units[kinds[k]];
        }
        fit.seconds[fit.times++] = trials[i].least.seconds[stage];
    }
    const double error = price_fit_solve(&fit, found);
    for (uint32_t k = 0; k < fit.kinds; k++) {
        prices->milli[kinds[k]] = rounded(found[k] * 1e12); /* to picoseconds */
    }
    return error;
}

/* Runs all trials in each round, so that a slow moment of the machine does not hit all runs of one trial. */
static int run_all(trial *trials, uint32_t rounds)
{
    int code = CLI_OK;
    for (uint32_t i = 0; i < rounds * TRIALS && code == CLI_OK; i++) {
        cli_progress("calibrating", i, rounds * TRIALS);
        code = run_trial(&trials[i % TRIALS]);
    }
    cli_progress_end();
    return code;
}

int calibrate(const processor_options *processor, uint32_t rounds, work_prices *prices, double errors[T3R_STAGE_COUNT])
{
    trial *trials = calloc(TRIALS, sizeof *trials);
    t3r_threads *threads = NULL;
    int code = trials != NULL ? CLI_OK : cli_error(CLI_BAD_INPUT, "out of memory");
    if (code == CLI_OK && processor->threads > 1 && (threads = t3r_threads_start(processor->threads)) == NULL) {
        code = cli_error(CLI_BAD_INPUT, "the system refuses %" PRIu32 " threads", processor->threads);
    }
    for (uint32_t i = 0; i < TRIALS && code == CLI_OK; i++) {
        trials[i].clock.threads = threads;
        code = open_trial(&trials[i], i, processor);
    }
    code = code == CLI_OK ? run_all(trials, rounds) : code;
    for (int stage = 0; stage < T3R_STAGE_COUNT && code == CLI_OK; stage++) {
        errors[stage] = fit_stage(trials, (t3r_stage)stage, prices);
    }
    for (uint32_t i = 0; i < TRIALS && trials != NULL; i++) {
        close_trial(&trials[i]);
    }
    t3r_threads_stop(threads);
    free(trials);
    return code;
}
