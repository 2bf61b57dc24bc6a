/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r bench: the speed of each stage, on a fixed piece of work: two 256x256 views of the built-in room. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <time.h>

#include "bench/bench_against.h"
#include "bench/bench_kernels.h"
#include "bench/bench_stages.h"
#include "bench/cpu_flags.h"
#include "bench/spread.h"
#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/options/processor_options.h"
#include "cli/tables/json_output.h"
#include "cli/text/word_list.h"
#include "cli/text/wrapped.h"
#include "host/cpu.h"
#include "planning/calibrate.h"
#include "planning/machine.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/options/option_names.h"

#define MAX_RUNS BENCH_TURNS_MOST
#define PATH_BYTES 4200
#define INDENT 23u /* of figures, after the names of stages */

typedef struct bench_options {
    bench_settings settings;
    const char *stages, *against;
    const char *output; /* of a calibration */
    uint32_t runs;
    bool calibrate, profile, json;
} bench_options;

enum { KEY_HEAD = 0x1000, KEY_DEPTH, KEY_RUNS };

static const struct argp_option options[] = {
    {"points", OPTION_TO(bench_options, settings.points), "FILE", OPTION_READS,
     "points to cluster instead of the room's: raw float32, N x 6", 0},
    {"head", KEY_HEAD, "tiny|small|FILE.t3w", OPTION_READS | OPTION_OR_WORD,
     "network of head_gmac_per_s and network_ms (small)", 0},
    {"depth", KEY_DEPTH, "SOURCE", 0,
     "source of depth of the scenes that are built and drawn: sensor (default), or stereo, from the colours", 0},
    {"stages", OPTION_TO(bench_options, stages), "LIST", 0, "rows to time, as kmeans_ms,stereo_ms (all)", 0},
    {"runs", KEY_RUNS, "N", 0, "number of timed runs of each stage, 1..101 (7)", 0},
    {"against", OPTION_TO(bench_options, against), "BINARY", OPTION_READS,
     "another trim3r, to run its bench and this one's in --runs turns: how many times as fast each stage is", 0},
    {"calibrate", OPTION_TO(bench_options, calibrate), NULL, 0,
     "measure instead the time of a unit of each kind of work on this machine, for trim3r plan --machine", 0},
    {"output", 'o', "MACHINE.json", OPTION_WRITES(FILE_OTHER), "file that --calibrate writes", 0},
    {"profile", OPTION_TO(bench_options, profile), NULL, 0, "print also each stage's time in a whole build", 0},
    {"json", OPTION_TO(bench_options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    bench_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->settings.processor;
        return 0;
    case KEY_HEAD:
        o->settings.head = option_head(state, "head", arg);
        return 0;
    case KEY_DEPTH:
        o->settings.depth = option_depth(state, "depth", arg);
        return 0;
    case KEY_RUNS:
        o->runs = option_number(state, "runs", arg, 1, MAX_RUNS);
        return 0;
    case 'o':
        o->output = arg;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, NULL, 0);
        return 0;
    case ARGP_KEY_END:
        if (o->calibrate != (o->output != NULL)) {
            argp_error(state, "--calibrate and -o MACHINE.json belong together");
        } else if (o->calibrate && o->against != NULL) {
            argp_error(state, "--calibrate and --against exclude each other");
        } else if (o->profile && (o->calibrate || o->against != NULL)) {
            argp_error(state, "--profile belongs to the rows, not to --calibrate or --against");
        }
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {{.argp = &processor_argp}, {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .doc = "Time the stages on two 256x256 views of the built-in room (131,072 points): the median of interleaved "
           "runs, with the least and the most, and the median for each pixel, point or pair; processor time of one "
           "thread, or with more of them elapsed time.\v"
           "Examples:\n"
           "  trim3r bench\n"
           "  trim3r bench --head tiny\n"
           "  trim3r bench --depth stereo\n"
           "  trim3r bench --json --runs 21\n"
           "  trim3r bench --stages build_small_ms --profile\n"
           "  trim3r bench --points cloud.f32 --stages kmeans_ms --json\n"
           "  trim3r bench --against ../older/trim3r --runs 15\n"
           "  trim3r bench --calibrate -o machine.json\n"
           "\n"
           "kmeans_msd: mean over the points of the squared distance, summed over the six numbers, to the centre of "
           "the SuperCluster each belongs to; K = 300, seed 1. The room's points are xyz over the median depth and rgb "
           "over 255; a file's (little-endian, any scale) are clustered and judged as they are. head_gmac_per_s: 10^9 "
           "multiply-accumulates of a head's layers per second of the whole head stage, with every point kept. "
           "network_ms: the layers of --head alone, over both views, 13,107 points kept. refine_ms: one refinement "
           "pass over both views, 13,107 Gaussians. stereo_ms: depth of both views from their colours, holes filled, "
           "with the four paths that --depth stereo takes; stereo_8_paths_ms: with eight. build_analytic_ms, "
           "build_unrefined_ms and build_small_ms include it with --depth stereo; the second is the first without "
           "refinement. A blended pair is a pixel and a splat that is drawn there, whole groups of eight columns. "
           "machine_gmac_per_s: 10^9 multiply-adds of 8-bit numbers a second, by the widest instruction that "
           "--cpu-mask leaves, all in registers. machine_copy_gb_per_s: 10^9 bytes a second, read and written, of 64 "
           "MiB that are copied.\n"
           "\n"
           "--against: the programs take turns, and each turn gives a ratio of times. Its median comes with the least "
           "and the most. Above 1, this program is the faster one. Stages that one of them lacks are named.",
    .children = children,
};

/* ---- the rows -------------------------------------------------------------------------------------------------- */

/* Chooses the rows to time from a comma-separated list of keys; NULL: all. */
static int choose_stages(const char *list, bool chosen[BENCH_STAGES_MOST])
{
    for (int s = 0; s < BENCH_STAGES_MOST; s++) {
        chosen[s] = list == NULL && bench_stages[s].key != NULL;
    }
    for (list_word w = word_first(list); w.text != NULL; w = word_next(w)) {
        int s = 0;
        while (bench_stages[s].key != NULL && !word_is(w, bench_stages[s].key)) {
            s++;
        }
        if (bench_stages[s].key == NULL) {
            return cli_error(CLI_BAD_USAGE, "--stages: no row is called '%.*s'; see trim3r bench", (int)w.length,
                             w.text);
        }
        chosen[s] = true;
    }
    return CLI_OK;
}

/* A timed row. */
typedef struct row {
    const bench_stage *stage; /* NULL: it is not chosen */
    double items;             /* items per run; 0 = not counted */
    double seconds[MAX_RUNS];
    spread taken;        /* of them */
    stage_times profile; /* the least of each stage; all 0 where none is wanted */
} row;

static int open_rows(bench_work *w, const bool chosen[BENCH_STAGES_MOST], row rows[BENCH_STAGES_MOST])
{
    for (int s = 0; s < BENCH_STAGES_MOST; s++) {
        if (!chosen[s]) {
            continue;
        }
        const t3r_status status = bench_work_open_scene(w, bench_stages[s].scene);
        if (status != T3R_OK) {
            return cli_error(CLI_BAD_INPUT, "the built-in room: %s", t3r_error_text(status));
        }
        rows[s].stage = &bench_stages[s];
    }
    return CLI_OK;
}

static double seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

/* Times one more build by stages, if requested. */
static bool profile_row(bench_work *w, const bench_options *o, row *r)
{
    stage_times times;
    if (!o->profile || !bench_stage_is_build(r->stage->key)) {
        return true;
    }
    const bool good = bench_work_profile(w, r->stage->scene, &times) == T3R_OK;
    if (good) {
        stage_times_keep_least(&r->profile, &times);
    }
    return good;
}

/* Times all rows in rounds, so that a slow moment of the machine affects each alike; the first round is not counted. */
static int time_rows(bench_work *w, const bench_options *o, row rows[BENCH_STAGES_MOST])
{
    clockid_t clock = o->settings.processor.threads > 1 ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID;
    for (uint32_t run = 0; run <= o->runs; run++) {
        for (uint32_t s = 0; s < BENCH_STAGES_MOST; s++) {
            const bench_stage *stage = rows[s].stage;
            if (stage == NULL) {
                continue;
            }
            double start = seconds_of(clock);
            const bool good = stage->run(w);
            const double end = seconds_of(clock);
            if (!good || !profile_row(w, o, &rows[s])) {
                return cli_error(CLI_BAD_INPUT, "%s: the stage failed", stage->key);
            }
            if (run > 0) {
                rows[s].seconds[run - 1] = end - start;
            }
            cli_progress(stage->key, run * BENCH_STAGES_MOST + s, (o->runs + 1) * BENCH_STAGES_MOST);
        }
    }
    cli_progress_end();
    for (uint32_t s = 0; s < BENCH_STAGES_MOST; s++) {
        rows[s].taken = spread_of(rows[s].seconds, o->runs);
        rows[s].items = rows[s].stage != NULL && rows[s].stage->items != NULL ? rows[s].stage->items(w) : 0;
    }
    return CLI_OK;
}

/* ---- output ------------------------------------------------------------------------------------------------------ */

typedef struct figures {
    double median, least, most; /* in the row's unit */
    double each_ns;             /* of an item, at the median */
} figures;

static figures figures_of(const row *r)
{
    const double first = bench_stage_figure(r->stage, r->taken.least, r->items);
    const double last = bench_stage_figure(r->stage, r->taken.most, r->items);
    return (figures){
        .median = bench_stage_figure(r->stage, r->taken.median, r->items),
        .least = first < last ? first : last, /* a rate is highest where the time is least */
        .most = first < last ? last : first,
        .each_ns = r->items > 0 ? r->taken.median * 1e9 / r->items : 0,
    };
}

/* Whether the points have their clusters. */
static bool are_clustered(const row rows[BENCH_STAGES_MOST])
{
    for (int s = 0; s < BENCH_STAGES_MOST; s++) {
        if (rows[s].stage != NULL && strcmp(rows[s].stage->key, "kmeans_ms") == 0) {
            return true;
        }
    }
    return false;
}

static void print_profiles(const row rows[BENCH_STAGES_MOST])
{
    for (int s = 0; s < BENCH_STAGES_MOST; s++) {
        if (stage_times_sum(&rows[s].profile) > 0) {
            printf("\n%s, the least time of each stage, that of its hash included:\n", rows[s].stage->key);
            stage_times_print(stdout, &rows[s].profile);
        }
    }
}

/* Adds "build_small_stages_ms" for the row build_small_ms. */
static void add_profiles(cJSON *root, const row rows[BENCH_STAGES_MOST])
{
    for (int s = 0; s < BENCH_STAGES_MOST; s++) {
        if (stage_times_sum(&rows[s].profile) > 0) {
            const char *name = rows[s].stage->key;
            char key[64];
            snprintf(key, sizeof key, "%.*s_stages_ms", (int)(strlen(name) - strlen("_ms")), name);
            stage_times_add_json(root, key, &rows[s].profile);
        }
    }
}

static void print_text(const bench_work *w, const row rows[BENCH_STAGES_MOST])
{
    char flags[CPU_FLAGS_BYTES];
    for (int s = 0; s < BENCH_STAGES_MOST; s++) {
        const bench_stage *stage = rows[s].stage;
        if (stage == NULL) {
            continue;
        }
        const figures f = figures_of(&rows[s]);
        char range[40];
        snprintf(range, sizeof range, "(%.3f to %.3f)", f.least, f.most);
        printf("%-22s %9.3f  ", stage->key, f.median);
        if (stage->each != NULL) {
            printf("%-22s %9.3f %s\n", range, f.each_ns, stage->each);
        } else {
            printf("%s\n", range);
        }
    }
    if (are_clustered(rows)) {
        printf("%-22s %9.5f  (%" PRIu32 " points)\n", "kmeans_msd", bench_points_mean_squared_distance(&w->points),
               w->points.count);
    }
    cpu_flags(flags);
    wrapped_print(stdout, INDENT, "cpu_flags", flags);
    bench_kernels_print(&w->kernels, INDENT);
    print_profiles(rows);
}

static void print_json(const bench_work *w, const bench_options *o, const row rows[BENCH_STAGES_MOST])
{
    char flags[CPU_FLAGS_BYTES], flags_used[64], key[64];
    cJSON *root = cJSON_CreateObject();
    for (int s = 0; s < BENCH_STAGES_MOST; s++) {
        const bench_stage *stage = rows[s].stage;
        if (stage == NULL) {
            continue;
        }
        const figures f = figures_of(&rows[s]);
        cJSON_AddNumberToObject(root, stage->key, f.median);
        snprintf(key, sizeof key, "%s_min", stage->key);
        cJSON_AddNumberToObject(root, key, f.least);
        snprintf(key, sizeof key, "%s_max", stage->key);
        cJSON_AddNumberToObject(root, key, f.most);
        if (stage->each_key != NULL) {
            cJSON_AddNumberToObject(root, stage->each_key, f.each_ns);
        }
    }
    if (are_clustered(rows)) {
        cJSON_AddNumberToObject(root, "kmeans_msd", bench_points_mean_squared_distance(&w->points));
        json_add_integer(root, "kmeans_points", w->points.count);
    }
    cJSON_AddStringToObject(root, "head", w->measured.name);
    cJSON_AddStringToObject(root, "head_bits", w->measured.bits);
    cJSON_AddStringToObject(root, "depth", t3r_depth_name(o->settings.depth));
    cpu_flags(flags);
    cJSON_AddStringToObject(root, "cpu_flags", flags);
    json_add_integer(root, "threads", o->settings.processor.threads);
    t3r_cpu_describe(o->settings.processor.cpu, flags_used, sizeof flags_used);
    cJSON_AddStringToObject(root, "cpu_used", flags_used);
    bench_kernels_add_json(root, &w->kernels);
    json_add_integer(root, "runs", o->runs);
    add_profiles(root, rows);
    json_print(root);
}

/* ---- the runs ---------------------------------------------------------------------------------------------------- */

static int run_alone(const bench_options *o, const bool chosen[BENCH_STAGES_MOST])
{
    bench_work w;
    row *rows = calloc(BENCH_STAGES_MOST, sizeof *rows);
    if (rows == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    int code = bench_work_open(&w, &o->settings);
    code = code == CLI_OK ? open_rows(&w, chosen, rows) : code;
    code = code == CLI_OK ? time_rows(&w, o, rows) : code;
    if (code == CLI_OK && o->json) {
        print_json(&w, o, rows);
    } else if (code == CLI_OK) {
        print_text(&w, rows);
    }
    bench_work_close(&w);
    free(rows);
    return code;
}

/* Passes the options that are not the default to both. */
static int run_against(const bench_options *o, const bool chosen[BENCH_STAGES_MOST])
{
    char points[PATH_BYTES], head[PATH_BYTES], depth[32], threads[32], mask[64];
    bench_contest contest = {.other = o->against, .chosen = chosen, .turns = o->runs, .json = o->json};
    const bench_settings *s = &o->settings;
    const processor_options usual = processor_defaults();
    if (s->points != NULL) {
        snprintf(points, sizeof points, "--points=%s", s->points);
        contest.passed[contest.passed_count++] = points;
    }
    if (strcmp(s->head, CHOSEN_HEAD_DEFAULT) != 0) {
        snprintf(head, sizeof head, "--head=%s", s->head);
        contest.passed[contest.passed_count++] = head;
    }
    if (s->depth != T3R_DEPTH_SENSOR) {
        snprintf(depth, sizeof depth, "--depth=%s", t3r_depth_name(s->depth));
        contest.passed[contest.passed_count++] = depth;
    }
    if (s->processor.threads != usual.threads) {
        snprintf(threads, sizeof threads, "--threads=%" PRIu32, s->processor.threads);
        contest.passed[contest.passed_count++] = threads;
    }
    if (s->processor.cpu != usual.cpu) {
        snprintf(mask, sizeof mask, "--cpu-mask=0x%" PRIx32, s->processor.cpu);
        contest.passed[contest.passed_count++] = mask;
    }
    return bench_against(&contest);
}

/* Writes this machine's prices to a file. */
static int run_calibration(const bench_options *o)
{
    machine m = {.threads = o->settings.processor.threads};
    double errors[T3R_STAGE_COUNT];
    char error[512] = "";
    t3r_cpu_describe(o->settings.processor.cpu, m.cpu, sizeof m.cpu);
    const int code = calibrate(&o->settings.processor, o->runs, &m.prices, errors);
    if (code != CLI_OK) {
        return code;
    }
    if (machine_write(&m, o->output, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (o->json) {
        cJSON *root = cJSON_CreateObject();
        cJSON_AddStringToObject(root, "machine", o->output);
        cJSON *worst = cJSON_AddObjectToObject(root, "largest_errors");
        for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
            cJSON_AddNumberToObject(worst, t3r_stage_name((t3r_stage)stage), errors[stage]);
        }
        json_print(root);
        return CLI_OK;
    }
    printf("%s: prices of %d kinds of work; largest error of a stage's time in a trial:\n", o->output, WORK_KIND_COUNT);
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        printf("%-14s %5.1f %%\n", t3r_stage_name((t3r_stage)stage), errors[stage] * 100);
    }
    return CLI_OK;
}

int command_bench(int argc, char **argv)
{
    bench_options o = {.settings = {.head = CHOSEN_HEAD_DEFAULT, .processor = processor_defaults()}, .runs = 7};
    file_options_parse(&argp, argc, argv, &o);

    if (o.calibrate) {
        return run_calibration(&o);
    }
    bool chosen[BENCH_STAGES_MOST];
    int code = choose_stages(o.stages, chosen);
    if (code != CLI_OK) {
        return code;
    }
    return o.against != NULL ? run_against(&o, chosen) : run_alone(&o, chosen);
}
