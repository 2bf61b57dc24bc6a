#include "bench/bench_work.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "room/room.h"
#include "bench/bench_limits.h"
#include "bench/bench_network.h"
#include "bench/bench_stereo.h"
#include "wavelet/wavelet.h"

#define REFINEMENTS 4u
#define SEED 1u
#define ERROR_BYTES 512

static const struct {
    uint32_t gaussians;
    enum { ANALYTIC, SMALL, MEASURED } head; /* the closed form; `small`; the one named by --head */
    bool keep;                               /* keep the analysis, to run a stage alone again */
    uint32_t refine;
    bool stereo; /* stereo, whatever --depth says */
} scene_settings[BENCH_SCENES] = {
    [BENCH_FULL] = {BENCH_POINTS, ANALYTIC, false, REFINEMENTS, false},
    [BENCH_TRIMMED] = {BENCH_TRIMMED_TO, ANALYTIC, false, REFINEMENTS, false},
    [BENCH_UNREFINED] = {BENCH_TRIMMED_TO, ANALYTIC, false, 0, false},
    [BENCH_LEARNED] = {BENCH_TRIMMED_TO, SMALL, false, REFINEMENTS, false},
    [BENCH_REFINED] = {BENCH_TRIMMED_TO, ANALYTIC, true, 1, false},
    [BENCH_MATCHED] = {BENCH_TRIMMED_TO, ANALYTIC, true, 0, true},
    [BENCH_HEADED] = {BENCH_POINTS, MEASURED, true, 0, false},
    [BENCH_NETWORKED] = {BENCH_TRIMMED_TO, MEASURED, true, 0, false},
};

t3r_status bench_work_build(bench_work *w, bench_scene kind)
{
    t3r_runtime *runtime = w->scene[kind].runtime;
    t3r_scene scene;
    const t3r_status status = bench_views_add(&w->views, runtime);
    return status == T3R_OK ? t3r_reconstruct(runtime, NULL, &scene) : status;
}

static t3r_hooks hooks_of(bench_work *w)
{
    return (t3r_hooks){.user = w->threads, .parallel_for = w->threads != NULL ? t3r_threads_run : NULL};
}

t3r_status bench_work_profile(bench_work *w, bench_scene kind, stage_times *times)
{
    t3r_runtime *runtime = w->scene[kind].runtime;
    stage_clock clock = {.threads = w->threads};
    const t3r_hooks timed = stage_clock_hooks(&clock), usual = hooks_of(w);
    t3r_status status = t3r_set_hooks(runtime, &timed);
    stage_times_begin(&clock.times, w->threads != NULL ? t3r_threads_count(w->threads) : 1);
    status = status == T3R_OK ? bench_work_build(w, kind) : status;
    *times = clock.times;
    return status == T3R_OK ? t3r_set_hooks(runtime, &usual) : status;
}

static t3r_status open_scene(bench_work *w, bench_scene kind)
{
    t3r_config config = t3r_default_config(BENCH_SIDE, BENCH_SIDE, BENCH_VIEWS, scene_settings[kind].gaussians);
    const chosen_head *heads[] = {[ANALYTIC] = NULL, [SMALL] = &w->small, [MEASURED] = &w->measured};
    const chosen_head *head = heads[scene_settings[kind].head];
    config.depth = scene_settings[kind].stereo ? T3R_DEPTH_STEREO : w->source;
    config.keep_analysis = scene_settings[kind].keep;
    config.refine = scene_settings[kind].refine;
    config.fit_passes = 0;
    if (head != NULL) {
        chosen_head_configure(head, &config);
    }
    t3r_plan_info plan;
    config.workers = w->threads != NULL ? t3r_threads_count(w->threads) : 1;
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK || posix_memalign(&w->scene[kind].arena, T3R_ARENA_ALIGN, plan.bytes) != 0) {
        w->scene[kind].arena = NULL;
        return T3R_ERR_ARENA;
    }
    status = t3r_init(&w->scene[kind].runtime, w->scene[kind].arena, plan.bytes, &config);
    const t3r_hooks hooks = hooks_of(w);
    if (status == T3R_OK) {
        (void)t3r_set_cpu(w->scene[kind].runtime, w->cpu);
        status = t3r_set_hooks(w->scene[kind].runtime, &hooks);
    }
    if (status == T3R_OK && head != NULL) {
        status = t3r_bind_head(w->scene[kind].runtime, head->weights, head->bytes);
    }
    return status == T3R_OK ? bench_work_build(w, kind) : status;
}

static t3r_status keep_start(bench_work *w)
{
    t3r_scene scene;
    t3r_status status = t3r_get_scene(w->scene[BENCH_REFINED].runtime, &scene);
    if (status != T3R_OK) {
        return status;
    }
    w->start = malloc(BENCH_TRIMMED_TO * sizeof *w->start);
    if (w->start == NULL) {
        return T3R_ERR_ARENA;
    }
    memcpy(w->start, scene.gaussians, scene.count * sizeof *w->start);
    return T3R_OK;
}

static t3r_status keep_features(bench_work *w)
{
    const t3r_runtime *runtime = w->scene[BENCH_NETWORKED].runtime;
    w->features = malloc(bench_network_bytes(runtime));
    if (w->features == NULL) {
        return T3R_ERR_ARENA;
    }
    bench_network_features(runtime, w->features);
    return T3R_OK;
}

t3r_status bench_work_draw(bench_work *w, bench_scene kind)
{
    t3r_target target = {.width = BENCH_SIDE, .height = BENCH_SIDE, .rgb = w->view, .rgb_stride_bytes = 3 * BENCH_SIDE};
    return t3r_render(w->scene[kind].runtime, &w->viewpoint, &target);
}

void bench_work_close(bench_work *w)
{
    bench_views_free(&w->views);
    for (int kind = 0; kind < BENCH_SCENES; kind++) {
        free(w->scene[kind].arena);
    }
    free(w->start);
    free(w->features);
    free(w->stereo_work);
    chosen_head_close(&w->small);
    chosen_head_close(&w->measured);
    free(w->view);
    free(w->wavelet_rgb);
    free(w->wavelet_planes);
    free(w->wavelet_plane);
    free(w->wavelet_work);
    free(w->texture);
    free(w->copy_from);
    free(w->copy_to);
    bench_points_free(&w->points);
    t3r_threads_stop(w->threads);
}

static bool allocate(bench_work *w)
{
    size_t pixels = (size_t)BENCH_WAVELET_WIDTH * BENCH_WAVELET_HEIGHT;
    const bool ok = bench_views_draw(&w->views, BENCH_SIDE, BENCH_SIDE, BENCH_VIEWS);
    w->view = malloc((size_t)BENCH_SIDE * BENCH_SIDE * 3);
    w->wavelet_rgb = malloc(pixels * 3);
    w->wavelet_planes = malloc(pixels * 3);
    w->wavelet_plane = malloc(pixels * sizeof *w->wavelet_plane);
    w->wavelet_work = malloc(T3R_WAVELET_ROW_BYTES(BENCH_WAVELET_WIDTH));
    w->texture = malloc(pixels * sizeof *w->texture);
    w->copy_from = calloc(BENCH_COPY_BYTES, 1);
    w->copy_to = malloc(BENCH_COPY_BYTES);
    if (posix_memalign(&w->stereo_work, T3R_ARENA_ALIGN,
                       bench_stereo_bytes(BENCH_SIDE, BENCH_SIDE, BENCH_MORE_PATHS)) != 0) {
        w->stereo_work = NULL;
    }
    return ok && w->view != NULL && w->wavelet_rgb != NULL && w->wavelet_planes != NULL && w->wavelet_plane != NULL &&
           w->wavelet_work != NULL && w->texture != NULL && w->stereo_work != NULL && w->copy_from != NULL &&
           w->copy_to != NULL;
}

static int open_heads(bench_work *w, const bench_settings *o)
{
    int code = chosen_head_open(&w->small, "small");
    if (code == CLI_OK) {
        code = chosen_head_open(&w->measured, o->head);
    }
    if (code == CLI_OK && w->measured.weights == NULL) {
        code = cli_error(CLI_BAD_USAGE, "--head %s: a network is measured; tiny, small, FILE.t3w", o->head);
    }
    return code;
}

int bench_work_open(bench_work *w, const bench_settings *o)
{
    *w = (bench_work){.source = o->depth};
    int code = open_heads(w, o);
    if (code != CLI_OK) {
        return code;
    }
    char error[ERROR_BYTES] = "";
    if (o->points != NULL && bench_points_read(&w->points, o->points, error, sizeof error)) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (!allocate(w)) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    w->cpu = o->processor.cpu;
    t3r_kernels_choose(&w->kernels, o->processor.cpu);
    if (o->processor.threads > 1 && (w->threads = t3r_threads_start(o->processor.threads)) == NULL) {
        return cli_error(CLI_BAD_INPUT, "the system refuses %" PRIu32 " threads", o->processor.threads);
    }
    /* a view between them */
    room_camera(1, BENCH_SIDE, BENCH_SIDE, &w->viewpoint);
    room_frame(0, BENCH_WAVELET_WIDTH, BENCH_WAVELET_HEIGHT, SEED, w->wavelet_rgb, NULL);
    size_t pixels = (size_t)BENCH_WAVELET_WIDTH * BENCH_WAVELET_HEIGHT;
    for (size_t i = 0; i < pixels * 3; i++) {
        w->wavelet_planes[i % 3 * pixels + i / 3] = w->wavelet_rgb[i];
    }
    if (o->points == NULL && bench_points_unproject(&w->points, BENCH_VIEWS, BENCH_SIDE, BENCH_SIDE, w->views.rgb,
                                                    w->views.depth, w->views.camera, error, sizeof error)) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    return CLI_OK;
}

t3r_status bench_work_open_scene(bench_work *w, bench_scene kind)
{
    if (kind == BENCH_NO_SCENE || w->scene[kind].arena != NULL) {
        return T3R_OK;
    }
    t3r_status status = open_scene(w, kind);
    if (status == T3R_OK && kind == BENCH_REFINED) {
        status = keep_start(w);
    }
    if (status == T3R_OK && kind == BENCH_NETWORKED) {
        status = keep_features(w);
    }
    return status;
}
