/* trim3r bench: the speed of each stage, on a fixed piece of work: two 256x256 views of the built-in room. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "study/bench/bench_head.h"
#include "study/bench/bench_kernels.h"
#include "study/bench/bench_points.h"
#include "study/bench/bench_refine.h"
#include "study/bench/bench_stereo.h"
#include "reconstruction/chosen_head.h"
#include "cli/cli.h"
#include "cli/file_options.h"
#include "cli/json_output.h"
#include "cli/option_values.h"
#include "cli/processor_options.h"
#include "cli/word_list.h"
#include "cpu.h"
#include "reconstruction/option_names.h"
#include "reconstruction/reconstruction.h"
#include "room/room.h"
#include "wavelet/wavelet.h"

#define SIDE 256u
#define VIEWS 2u
#define POINTS (SIDE * SIDE * VIEWS)
#define TRIMMED_TO 13107u /* 10 % of them */
#define REFINEMENTS 4u
#define SEED 1u
#define MORE_PATHS 8u /* of stereo, beside the four of the pipeline */
#define WAVELET_WIDTH 1280u
#define WAVELET_HEIGHT 720u
#define MAX_RUNS 101u
#define ERROR_BYTES 512

typedef struct bench_options {
    const char *points, *head, *stages;
    t3r_depth depth;
    uint32_t runs;
    processor_options processor;
    bool json;
} bench_options;

enum { KEY_POINTS = 0x1000, KEY_HEAD, KEY_DEPTH, KEY_STAGES, KEY_RUNS, KEY_JSON };

static const struct argp_option options[] = {
    {"points", KEY_POINTS, "FILE", OPTION_READS, "points to cluster instead of the room's: raw float32, N x 6", 0},
    {"head", KEY_HEAD, "HEAD", OPTION_READS | OPTION_OR_WORD,
     "network of head_gmac_per_s: nano, small (default), base, or FILE.t3w", 0},
    {"depth", KEY_DEPTH, "SOURCE", 0,
     "source of depth of the scenes that are built and drawn: sensor (default), or stereo, from the colours", 0},
    {"stages", KEY_STAGES, "LIST", 0, "rows to time, as kmeans_ms,stereo_ms (all)", 0},
    {"runs", KEY_RUNS, "N", 0, "number of timed runs of each stage, 1..101 (7)", 0},
    {"json", KEY_JSON, NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    bench_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->processor;
        return 0;
    case KEY_POINTS:
        o->points = arg;
        return 0;
    case KEY_HEAD:
        o->head = option_head(state, "head", arg);
        return 0;
    case KEY_DEPTH:
        o->depth = option_depth(state, "depth", arg);
        return 0;
    case KEY_STAGES:
        o->stages = arg;
        return 0;
    case KEY_RUNS:
        o->runs = option_number(state, "runs", arg, 1, MAX_RUNS);
        return 0;
    case KEY_JSON:
        o->json = true;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, NULL, 0);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{.argp = &processor_argp}, {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .doc =
        "Time the stages on two 256x256 views of the built-in room (131,072 points): the median of interleaved runs, "
        "with "
        "the least and the most beside; processor time of one thread, or with more of them elapsed time."
        "\vExamples:\n"
        "  trim3r bench\n"
        "  trim3r bench --head base\n"
        "  trim3r bench --depth stereo\n"
        "  trim3r bench --json --runs 21\n"
        "  trim3r bench --points cloud.f32 --stages kmeans_ms --json\n\n"
        "kmeans_msd: mean over the points of the squared distance, summed over the six numbers, to the centre of the "
        "SuperCluster each belongs to; K = 300, seed 1. The room's points are xyz over the median depth and rgb over "
        "255; a file's (little-endian, any scale) are clustered and judged as they are. head_gmac_per_s: 10^9 "
        "multiply-accumulates of a head's layers a second of the whole head stage, every point kept. refine_ms: one "
        "refinement pass over both views, 13,107 Gaussians. stereo_ms: depth of both views from their colours, holes "
        "filled, with the four paths that --depth stereo takes; stereo_8_paths_ms: with eight. build_analytic_ms and "
        "build_small_ms have it in them with --depth stereo.",
    .children = children,
};

/* ---- the work ---------------------------------------------------------------------------------------------------- */

/* What the stages work on, each built before the first of them that needs it. */
typedef enum scene_kind { FULL, TRIMMED, LEARNED, REFINED, MATCHED, HEADED, SCENES, NO_SCENE = SCENES } scene_kind;

static const struct {
    uint32_t gaussians;
    enum { ANALYTIC, SMALL, MEASURED } head; /* the closed form; `small`; the one that --head names */
    bool keep;                               /* the analysis, to run a stage alone again */
    uint32_t refinements;
    bool stereo; /* whatever --depth says */
} scene_settings[SCENES] = {
    [FULL] = {POINTS, ANALYTIC, false, REFINEMENTS, false},
    [TRIMMED] = {TRIMMED_TO, ANALYTIC, false, REFINEMENTS, false},
    [LEARNED] = {TRIMMED_TO, SMALL, false, REFINEMENTS, false},
    [REFINED] = {TRIMMED_TO, ANALYTIC, true, 1, false},
    [MATCHED] = {TRIMMED_TO, ANALYTIC, true, 0, true},
    [HEADED] = {POINTS, MEASURED, true, 0, false},
};

typedef struct scene_bench {
    t3r_runtime *runtime;
    void *arena;
} scene_bench;

typedef struct workload {
    uint8_t *rgb[VIEWS];
    uint16_t *depth[VIEWS];
    t3r_depth source; /* of the scenes' depth */
    t3r_camera camera[VIEWS];
    t3r_camera viewpoint;
    scene_bench scene[SCENES];
    t3r_gaussian *start; /* what each measured pass of refinement begins with: its scene as it was built */
    void *stereo_work;   /* of a pair matched with eight paths */
    chosen_head small, measured;
    t3r_threads *threads;
    uint32_t cpu; /* features that kernels may use */
    t3r_kernels kernels;
    uint8_t *view; /* where renders go */
    uint8_t *wavelet_rgb;
    uint8_t *wavelet_planes;
    int16_t *wavelet_plane, *wavelet_work;
    uint16_t *texture;
    bench_points points;
    double kmeans_msd;
} workload;

static t3r_status build(workload *w, t3r_runtime *runtime)
{
    t3r_scene scene;
    t3r_status status = t3r_reset(runtime);
    for (uint32_t v = 0; v < VIEWS && status == T3R_OK; v++) {
        t3r_frame frame = {
            .format = T3R_PIXEL_RGB24,
            .width = SIDE,
            .height = SIDE,
            .planes = {w->rgb[v]},
            .stride_bytes = {3 * SIDE},
            .depth = (const uint8_t *)w->depth[v], /* little-endian hosts: the bench compares times, not bits */
            .depth_width = SIDE,
            .depth_height = SIDE,
            .depth_stride_bytes = 2 * SIDE,
            .depth_unit_q40 = ROOM_DEPTH_UNIT_Q40,
        };
        status = t3r_add_view(runtime, &frame, &w->camera[v]);
    }
    return status == T3R_OK ? t3r_reconstruct(runtime, NULL, &scene) : status;
}

static t3r_status open_scene(workload *w, scene_kind kind)
{
    scene_bench *s = &w->scene[kind];
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, scene_settings[kind].gaussians);
    const chosen_head *heads[] = {[ANALYTIC] = NULL, [SMALL] = &w->small, [MEASURED] = &w->measured};
    const chosen_head *head = heads[scene_settings[kind].head];
    config.depth = scene_settings[kind].stereo ? T3R_DEPTH_STEREO : w->source;
    config.keep_analysis = scene_settings[kind].keep;
    config.refinements = scene_settings[kind].refinements;
    if (head != NULL) {
        chosen_head_configure(head, &config);
    }
    t3r_plan_info plan;
    config.workers = w->threads != NULL ? t3r_threads_count(w->threads) : 1;
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK || posix_memalign(&s->arena, T3R_ARENA_ALIGN, plan.bytes) != 0) {
        s->arena = NULL;
        return T3R_ERR_ARENA;
    }
    status = t3r_init(&s->runtime, s->arena, plan.bytes, &config);
    t3r_hooks hooks = {.user = w->threads, .parallel_for = w->threads != NULL ? t3r_threads_run : NULL};
    if (status == T3R_OK) {
        (void)t3r_set_cpu(s->runtime, w->cpu);
        status = t3r_set_hooks(s->runtime, &hooks);
    }
    if (status == T3R_OK && head != NULL) {
        status = t3r_bind_head(s->runtime, head->weights, head->bytes);
    }
    return status == T3R_OK ? build(w, s->runtime) : status;
}

static t3r_status keep_start(workload *w)
{
    t3r_scene scene;
    t3r_status status = t3r_get_scene(w->scene[REFINED].runtime, &scene);
    if (status != T3R_OK) {
        return status;
    }
    w->start = malloc(TRIMMED_TO * sizeof *w->start);
    if (w->start == NULL) {
        return T3R_ERR_ARENA;
    }
    memcpy(w->start, scene.gaussians, scene.count * sizeof *w->start);
    return T3R_OK;
}

static t3r_status draw(workload *w, t3r_runtime *runtime)
{
    t3r_target target = {.width = SIDE, .height = SIDE, .rgb = w->view, .rgb_stride_bytes = 3 * SIDE};
    return t3r_render(runtime, &w->viewpoint, &target);
}

static void close_workload(workload *w)
{
    for (uint32_t v = 0; v < VIEWS; v++) {
        free(w->rgb[v]);
        free(w->depth[v]);
    }
    for (int kind = 0; kind < SCENES; kind++) {
        free(w->scene[kind].arena);
    }
    free(w->start);
    free(w->stereo_work);
    chosen_head_close(&w->small);
    chosen_head_close(&w->measured);
    free(w->view);
    free(w->wavelet_rgb);
    free(w->wavelet_planes);
    free(w->wavelet_plane);
    free(w->wavelet_work);
    free(w->texture);
    bench_points_free(&w->points);
    t3r_threads_stop(w->threads);
}

static bool allocate(workload *w)
{
    size_t pixels = (size_t)WAVELET_WIDTH * WAVELET_HEIGHT;
    bool ok = true;
    for (uint32_t v = 0; v < VIEWS; v++) {
        w->rgb[v] = malloc((size_t)SIDE * SIDE * 3);
        w->depth[v] = malloc((size_t)SIDE * SIDE * 2);
        ok = ok && w->rgb[v] != NULL && w->depth[v] != NULL;
    }
    w->view = malloc((size_t)SIDE * SIDE * 3);
    w->wavelet_rgb = malloc(pixels * 3);
    w->wavelet_planes = malloc(pixels * 3);
    w->wavelet_plane = malloc(pixels * sizeof *w->wavelet_plane);
    w->wavelet_work = malloc(T3R_WAVELET_ROW_BYTES(WAVELET_WIDTH));
    w->texture = malloc(pixels * sizeof *w->texture);
    if (posix_memalign(&w->stereo_work, T3R_ARENA_ALIGN, bench_stereo_bytes(SIDE, SIDE, MORE_PATHS)) != 0) {
        w->stereo_work = NULL;
    }
    return ok && w->view != NULL && w->wavelet_rgb != NULL && w->wavelet_planes != NULL && w->wavelet_plane != NULL &&
           w->wavelet_work != NULL && w->texture != NULL && w->stereo_work != NULL;
}

static int open_heads(workload *w, const bench_options *o)
{
    int code = chosen_head_open(&w->small, "small");
    if (code == CLI_OK) {
        code = chosen_head_open(&w->measured, o->head);
    }
    if (code == CLI_OK && w->measured.weights == NULL) {
        code = cli_error(CLI_BAD_USAGE, "--head %s: a network is measured; nano, small, base, FILE.t3w", o->head);
    }
    return code;
}

static int open_workload(workload *w, const bench_options *o)
{
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
    /* context views 0 and 2, seen from view 1 between them */
    for (uint32_t v = 0; v < VIEWS; v++) {
        room_camera(2 * v, SIDE, SIDE, &w->camera[v]);
        room_frame(2 * v, SIDE, SIDE, SEED, w->rgb[v], w->depth[v]);
    }
    room_camera(1, SIDE, SIDE, &w->viewpoint);
    room_frame(0, WAVELET_WIDTH, WAVELET_HEIGHT, SEED, w->wavelet_rgb, NULL);
    size_t pixels = (size_t)WAVELET_WIDTH * WAVELET_HEIGHT;
    for (size_t i = 0; i < pixels * 3; i++) {
        w->wavelet_planes[i % 3 * pixels + i / 3] = w->wavelet_rgb[i];
    }
    if (o->points == NULL &&
        bench_points_unproject(&w->points, VIEWS, SIDE, SIDE, w->rgb, w->depth, w->camera, error, sizeof error)) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    return CLI_OK;
}

/* ---- the stages -------------------------------------------------------------------------------------------------- */

static bool run_raster_full(workload *w)
{
    return draw(w, w->scene[FULL].runtime) == T3R_OK;
}

static bool run_raster_trimmed(workload *w)
{
    return draw(w, w->scene[TRIMMED].runtime) == T3R_OK;
}

static bool run_build(workload *w)
{
    return build(w, w->scene[TRIMMED].runtime) == T3R_OK;
}

static bool run_build_learned(workload *w)
{
    return build(w, w->scene[LEARNED].runtime) == T3R_OK;
}

static bool run_head(workload *w)
{
    return bench_head_run(w->scene[HEADED].runtime);
}

static bool run_refine(workload *w)
{
    return bench_refine_run(w->scene[REFINED].runtime, w->start);
}

static bool run_stereo(workload *w)
{
    return bench_stereo_run(w->scene[MATCHED].runtime);
}

static bool run_stereo_8_paths(workload *w)
{
    return bench_stereo_paths_run(w->scene[MATCHED].runtime, MORE_PATHS, w->stereo_work);
}

static bool run_kmeans(workload *w)
{
    return bench_points_cluster(&w->points, w->cpu);
}

static bool run_texture(workload *w)
{
    size_t pixels = (size_t)WAVELET_WIDTH * WAVELET_HEIGHT;
    const uint8_t *colour[3] = {w->wavelet_planes, w->wavelet_planes + pixels, w->wavelet_planes + 2 * pixels};
    t3r_wavelet_texture(&w->kernels, colour, WAVELET_WIDTH, WAVELET_HEIGHT, 2, T3R_WAVELET_DB2, w->texture,
                        w->wavelet_plane, w->wavelet_work);
    return true;
}

#define MILLISECONDS 1e3
#define NANOSECONDS_A_PIXEL (1e9 / ((double)WAVELET_WIDTH * WAVELET_HEIGHT))

static const struct {
    const char *key;
    bool (*run)(workload *w);
    double unit; /* per second; 0: 10^9 multiply-accumulates of the head a second */
    scene_kind scene;
} stages[] = {
    {"raster_131k_ms", run_raster_full, MILLISECONDS, FULL},
    {"raster_13k_ms", run_raster_trimmed, MILLISECONDS, TRIMMED},
    {"refine_ms", run_refine, MILLISECONDS, REFINED},
    {"stereo_ms", run_stereo, MILLISECONDS, MATCHED},
    {"stereo_8_paths_ms", run_stereo_8_paths, MILLISECONDS, MATCHED},
    {"kmeans_ms", run_kmeans, MILLISECONDS, NO_SCENE},
    {"texture_ns_per_pixel", run_texture, NANOSECONDS_A_PIXEL, NO_SCENE},
    {"build_analytic_ms", run_build, MILLISECONDS, TRIMMED},
    {"build_small_ms", run_build_learned, MILLISECONDS, LEARNED},
    {"head_gmac_per_s", run_head, 0, HEADED},
};
enum { STAGE_COUNT = sizeof stages / sizeof stages[0] };

/* Which stages are timed, of a comma-separated list of keys; NULL: all. */
static int choose_stages(const char *list, bool chosen[STAGE_COUNT])
{
    for (int s = 0; s < STAGE_COUNT; s++) {
        chosen[s] = list == NULL;
    }
    for (list_word w = word_first(list); w.text != NULL; w = word_next(w)) {
        int s = 0;
        while (s < STAGE_COUNT && !word_is(w, stages[s].key)) {
            s++;
        }
        if (s == STAGE_COUNT) {
            return cli_error(CLI_BAD_USAGE, "--stages: no row is called '%.*s'; see trim3r bench", (int)w.length,
                             w.text);
        }
        chosen[s] = true;
    }
    return CLI_OK;
}

/* Whether the points have their clusters afterwards. */
static bool clusters(const bool chosen[STAGE_COUNT])
{
    bool any = false;
    for (int s = 0; s < STAGE_COUNT; s++) {
        any = any || (chosen[s] && stages[s].run == run_kmeans);
    }
    return any;
}

static int open_scenes(workload *w, const bool chosen[STAGE_COUNT])
{
    t3r_status status = T3R_OK;
    for (int s = 0; s < STAGE_COUNT && status == T3R_OK; s++) {
        scene_kind kind = stages[s].scene;
        if (!chosen[s] || kind == NO_SCENE || w->scene[kind].arena != NULL) {
            continue;
        }
        status = open_scene(w, kind);
        if (status == T3R_OK && kind == REFINED) {
            status = keep_start(w);
        }
    }
    return status == T3R_OK ? CLI_OK : cli_error(CLI_BAD_INPUT, "the built-in room: %s", t3r_error_text(status));
}

static double seconds(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

static int compare_doubles(const void *a, const void *b)
{
    double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

static double median(const double *sorted, uint32_t count)
{
    return (sorted[(count - 1) / 2] + sorted[count / 2]) / 2;
}

/* Round after round through all stages, so that a slow moment of the machine hits each alike; the first is not counted.
 */
static int time_stages(workload *w, const bench_options *o, const bool chosen[STAGE_COUNT],
                       double times[STAGE_COUNT][MAX_RUNS])
{
    const double giga_macs = bench_head_macs(w->measured.weights, SIDE, SIDE, VIEWS) / 1e9;
    clockid_t clock = o->processor.threads > 1 ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID;
    for (uint32_t run = 0; run <= o->runs; run++) {
        for (int s = 0; s < STAGE_COUNT; s++) {
            if (!chosen[s]) {
                continue;
            }
            double start = seconds(clock);
            if (!stages[s].run(w)) {
                return cli_error(CLI_BAD_INPUT, "%s: the stage failed", stages[s].key);
            }
            if (run > 0) {
                double taken = seconds(clock) - start;
                times[s][run - 1] = stages[s].unit > 0 ? taken * stages[s].unit : giga_macs / taken;
            }
            cli_progress(stages[s].key, run * STAGE_COUNT + (uint32_t)s, (o->runs + 1) * STAGE_COUNT);
        }
    }
    cli_progress_end();
    for (int s = 0; s < STAGE_COUNT; s++) {
        qsort(times[s], o->runs, sizeof times[s][0], compare_doubles);
    }
    return CLI_OK;
}

/* The processor's vector extensions, as the system names them; "" where it names none. */
static void read_cpu_flags(char *flags, size_t flags_bytes)
{
    static const char *const families[] = {"sse", "ssse", "avx", "fma", "asimd", "neon", "sve", "mve"};
    flags[0] = '\0';
    char line[8192];
    FILE *file = fopen("/proc/cpuinfo", "r");
    while (file != NULL && fgets(line, sizeof line, file) != NULL) {
        if (strncmp(line, "flags", 5) != 0 && strncmp(line, "Features", 8) != 0) {
            continue;
        }
        size_t length = 0;
        char *rest = NULL;
        for (char *word = strtok_r(line, " \t\n:", &rest); word != NULL; word = strtok_r(NULL, " \t\n:", &rest)) {
            for (size_t i = 0; i < sizeof families / sizeof families[0]; i++) {
                if (strncmp(word, families[i], strlen(families[i])) == 0 && length + strlen(word) + 2 < flags_bytes) {
                    length +=
                        (size_t)snprintf(flags + length, flags_bytes - length, "%s%s", length == 0 ? "" : " ", word);
                    break;
                }
            }
        }
        break;
    }
    if (file != NULL) {
        fclose(file);
    }
}

/* The inner loops by the instruction set of their variants; those that are not named have plain C alone. */
static void print_kernels(const t3r_kernels *kernels)
{
    bench_kernel list[BENCH_KERNELS_MOST];
    const uint32_t count = bench_kernels_of(kernels, list);
    bool listed[BENCH_KERNELS_MOST] = {false};
    printf("%-22s", "kernels");
    for (uint32_t i = 0; i < count; i++) {
        if (listed[i]) {
            continue;
        }
        printf("%s %s:", i == 0 ? "" : ";", list[i].set);
        for (uint32_t k = i; k < count; k++) {
            if (strcmp(list[k].set, list[i].set) == 0) {
                printf(" %s", list[k].entry);
                listed[k] = true;
            }
        }
    }
    printf("\n");
}

static void add_kernels(cJSON *root, const t3r_kernels *kernels)
{
    bench_kernel list[BENCH_KERNELS_MOST];
    const uint32_t count = bench_kernels_of(kernels, list);
    cJSON *object = cJSON_AddObjectToObject(root, "kernels");
    for (uint32_t i = 0; i < count; i++) {
        cJSON_AddStringToObject(object, list[i].entry, list[i].set);
    }
}

static void print_results(const workload *w, const bench_options *o, const bool chosen[STAGE_COUNT],
                          double times[STAGE_COUNT][MAX_RUNS])
{
    char flags[1024], flags_used[64];
    read_cpu_flags(flags, sizeof flags);
    if (!o->json) {
        for (int s = 0; s < STAGE_COUNT; s++) {
            if (!chosen[s]) {
                continue;
            }
            printf("%-22s %9.3f  (%.3f to %.3f)\n", stages[s].key, median(times[s], o->runs), times[s][0],
                   times[s][o->runs - 1]);
        }
        if (clusters(chosen)) {
            printf("%-22s %9.5f  (%" PRIu32 " points)\n", "kmeans_msd", w->kmeans_msd, w->points.count);
        }
        printf("%-22s %s\n", "cpu_flags", flags);
        print_kernels(&w->kernels);
        return;
    }
    cJSON *root = cJSON_CreateObject();
    for (int s = 0; s < STAGE_COUNT; s++) {
        if (!chosen[s]) {
            continue;
        }
        char key[64];
        cJSON_AddNumberToObject(root, stages[s].key, median(times[s], o->runs));
        snprintf(key, sizeof key, "%s_min", stages[s].key);
        cJSON_AddNumberToObject(root, key, times[s][0]);
        snprintf(key, sizeof key, "%s_max", stages[s].key);
        cJSON_AddNumberToObject(root, key, times[s][o->runs - 1]);
    }
    if (clusters(chosen)) {
        cJSON_AddNumberToObject(root, "kmeans_msd", w->kmeans_msd);
        json_add_integer(root, "kmeans_points", w->points.count);
    }
    cJSON_AddStringToObject(root, "head", w->measured.name);
    cJSON_AddStringToObject(root, "head_bits", w->measured.bits);
    cJSON_AddStringToObject(root, "depth", t3r_depth_name(o->depth));
    cJSON_AddStringToObject(root, "cpu_flags", flags);
    json_add_integer(root, "threads", o->processor.threads);
    t3r_cpu_describe(o->processor.cpu, flags_used, sizeof flags_used);
    cJSON_AddStringToObject(root, "cpu_used", flags_used);
    add_kernels(root, &w->kernels);
    json_add_integer(root, "runs", o->runs);
    json_print(root);
}

int command_bench(int argc, char **argv)
{
    bench_options o = {.head = CHOSEN_HEAD_DEFAULT, .runs = 7, .processor = processor_defaults()};
    file_options_parse(&argp, argc, argv, &o);

    bool chosen[STAGE_COUNT];
    int code = choose_stages(o.stages, chosen);
    if (code != CLI_OK) {
        return code;
    }
    workload w = {.source = o.depth};
    double times[STAGE_COUNT][MAX_RUNS] = {0};
    code = open_workload(&w, &o);
    if (code == CLI_OK) {
        code = open_scenes(&w, chosen);
    }
    if (code == CLI_OK) {
        code = time_stages(&w, &o, chosen, times);
    }
    if (code == CLI_OK) {
        w.kmeans_msd = clusters(chosen) ? bench_points_mean_squared_distance(&w.points) : 0;
        print_results(&w, &o, chosen, times);
    }
    close_workload(&w);
    return code;
}
