/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r plan: what an arena holds and how much work a build is, before anything runs; or which settings fit. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/options/processor_options.h"
#include "cli/tables/json_output.h"
#include "core/fixed.h"
#include "pictures/plan_picture.h"
#include "planning/choices.h"
#include "planning/fitting.h"
#include "planning/plan_code.h"
#include "planning/ram.h"
#include "planning/work_table.h"
#include "reconstruction/options/head_option.h"
#include "reconstruction/options/option_names.h"
#include "reconstruction/options/settings.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/reconstruction_error.h"

typedef struct plan_options {
    t3r_config config; /* without the head; a render_width of 0 is the working size */
    uint64_t within;   /* bytes of the arena; 0 = as many as it takes */
    uint64_t ram;      /* bytes of RAM; 0 = the settings are given */
    double keep;       /* the budget as percent of the points; 0 = as a count */
    fitting_options fitting;
    bool json, markdown;
    const char *svg, *header, *head; /* head: NULL = the default, or in a list each */
} plan_options;

#define LISTED_SIDE 256u /* default width and height of a list: what its expected losses were measured at */

enum {
    KEY_SIZE = 0x1000,
    KEY_VIEWS,
    KEY_GAUSSIANS,
    KEY_WITHIN,
    KEY_RAM,
    KEY_PRESET,
    KEY_RENDER,
    KEY_KEEP,
    KEY_KEEP_ANALYSIS,
    KEY_STREAM,
    KEY_ARENA,
    KEY_TIME,
    KEY_THREADS
};

static const struct argp_option options[] = {
    {"size", KEY_SIZE, "WxH", 0, "working size of the context views (needed; with --arena or --time 256x256)", 0},
    {"views", KEY_VIEWS, "N", 0, "number of context views, 0..16; 0 = an arena that only renders (2)", 0},
    {"gaussians", KEY_GAUSSIANS, "Z", 0, "budget (needed, or --keep, --within, --arena or --time)", 0},
    {"keep", KEY_KEEP, "P%", 0, "budget in percent of the pixels of all views", 0},
    {"arena", KEY_ARENA, "BYTES[K|M|G]", 0,
     "bytes of an arena: list the settings that fit, those of the least expected loss first", 0},
    {"time", KEY_TIME, "TIME", 0, "most time of a build, as 100ms or 0.5s: list the settings that fit", 0},
    {"machine", OPTION_TO(plan_options, fitting.machine), "MACHINE.json", OPTION_READS,
     "machine, measured by trim3r bench --calibrate, whose times are predicted (with --time this one, measured now)",
     0},
    {"within", KEY_WITHIN, "BYTES[K|M|G]", 0,
     "bytes of an arena, for the largest budget that it can hold, at most --gaussians (all points of the views)", 0},
    {"ram", KEY_RAM, "BYTES[K|M|G]", 0,
     "bytes of a device's RAM, as 256K or 4M: print the best settings for it, and what uses it", 0},
    {"preset", KEY_PRESET, "fast|balanced|best", 0, "build's head and refinement for an amount of work", 0},
    {"render", KEY_RENDER, "WxH", 0, "largest picture to draw (the working size)", 0},
    {"keep-analysis", KEY_KEEP_ANALYSIS, NULL, 0, "keep the analysis after the build, so that the budget can change",
     0},
    {"stream", KEY_STREAM, NULL, 0,
     "a map of --gaussians that follows a camera, with --views newest keyframes, instead of builds", 0},
    {"threads", KEY_THREADS, "N|all", 0,
     "number of threads that share the arena's work, 1..16, or all: one for each processor (1)", 0},
    {"svg", OPTION_TO(plan_options, svg), "FILE", OPTION_WRITES(FILE_SVG) | OPTION_PIPE,
     "picture of the arena to write: stages across, bytes upwards", 0},
    {"header", OPTION_TO(plan_options, header), "FILE.h", OPTION_WRITES(FILE_HEADER),
     "header in C to write for a firmware: the arena's bytes, and a function that returns the settings", 0},
    {"markdown", OPTION_TO(plan_options, markdown), NULL, 0, "print the table of the arena, or the list, in Markdown",
     0},
    {"json", OPTION_TO(plan_options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static bool lists(const plan_options *o)
{
    return o->fitting.bytes != 0 || o->fitting.nanoseconds != 0;
}

/* Returns the first option given that asks for one arena; NULL: none. */
static const char *of_one_arena(const plan_options *o)
{
    return o->svg != NULL          ? "svg"
           : o->header != NULL     ? "header"
           : o->config.stream != 0 ? "stream"
           : o->within != 0        ? "within"
                                   : NULL;
}

static t3r_config unset(void)
{
    t3r_config config = t3r_default_config(0, 0, 2, 0);
    config.refine = CHOICES_ANY_REFINE;
    return config;
}

static void check_options(struct argp_state *state, plan_options *o)
{
    t3r_config *c = &o->config;
    if (o->ram != 0) {
        const t3r_config as_before = unset();
        if (memcmp(c, &as_before, sizeof *c) != 0 || o->within != 0 || o->keep > 0 || lists(o) || o->svg != NULL ||
            o->header != NULL || o->markdown || o->head != NULL || o->fitting.machine != NULL) {
            argp_error(state, "--ram chooses the settings: --json alone goes with it");
        }
        return;
    }
    if (lists(o) && c->width == 0) {
        c->width = c->height = LISTED_SIDE;
    }
    if (c->width == 0) {
        argp_error(state, "--size WxH is missing");
    } else if (c->gaussians == 0 && o->keep <= 0 && o->within == 0 && !lists(o)) {
        argp_error(state, "--gaussians Z, --keep P%%, --within BYTES, --arena BYTES or --time TIME is missing");
    } else if (c->gaussians != 0 && o->keep > 0) {
        argp_error(state, "--gaussians and --keep exclude each other");
    } else if (lists(o) && of_one_arena(o) != NULL) {
        argp_error(state, "--%s belongs to one arena, not to a list of settings", of_one_arena(o));
    } else if (c->stream == 0 && stream_setting_given(c) != NULL) {
        argp_error(state, "--%s belongs to --stream", stream_setting_given(c));
    } else if (lists(o) && c->views == 0) {
        argp_error(state, "--views 0 builds nothing that could fit a time or an arena");
    } else if (o->json && o->markdown) {
        argp_error(state, "--json and --markdown exclude each other");
    }
    if (o->keep > 0) {
        const uint64_t points = (uint64_t)c->width * c->height * (c->views > 0 ? c->views : 1);
        c->gaussians = c->max_gaussians = T3R_MIN(reconstruction_budget((uint32_t)points, o->keep), T3R_MAX_GAUSSIANS);
    }
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    plan_options *o = state->input;
    t3r_config *c = &o->config;
    uint32_t count;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = c;
        state->child_inputs[1] = c;
        state->child_inputs[2] = &o->head;
        return 0;
    case KEY_SIZE:
        option_size(state, "size", arg, T3R_MIN_SIDE, &c->width, &c->height);
        return 0;
    case KEY_VIEWS:
        c->views = option_number(state, "views", arg, 0, T3R_MAX_VIEWS);
        return 0;
    case KEY_GAUSSIANS:
        c->gaussians = c->max_gaussians = option_number(state, "gaussians", arg, 1, T3R_MAX_GAUSSIANS);
        return 0;
    case KEY_KEEP:
        option_keep(state, arg, &o->keep, 1, &count);
        return 0;
    case KEY_ARENA:
        o->fitting.bytes = option_bytes(state, "arena", arg);
        return 0;
    case KEY_TIME:
        o->fitting.nanoseconds = option_time(state, "time", arg);
        return 0;
    case KEY_WITHIN:
        o->within = option_bytes(state, "within", arg);
        return 0;
    case KEY_RAM:
        o->ram = option_bytes(state, "ram", arg);
        return 0;
    case KEY_PRESET:
        option_preset(state, "preset", arg, &o->config, &o->head);
        return 0;
    case KEY_RENDER:
        option_size(state, "render", arg, 1, &c->render_width, &c->render_height);
        return 0;
    case KEY_KEEP_ANALYSIS:
        c->keep_analysis = 1;
        return 0;
    case KEY_STREAM:
        c->stream = 1;
        return 0;
    case KEY_THREADS:
        c->workers = option_threads(state, arg);
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, NULL, 0);
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child children[] = {
    {.argp = &settings_argp}, {.argp = &stream_settings_argp}, {.argp = &head_argp}, {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .doc =
        "Print an arena's buffers, the least bytes that work, the bytes for full speed, and a build's operations; or "
        "list the settings that fit an arena and a time."
        "\vExamples:\n"
        "  trim3r plan --size 256x256 --views 2 --gaussians 13107\n"
        "  trim3r plan --size 256x256 --keep 10% --head analytic\n"
        "  trim3r plan --size 96x96 --within 512K\n"
        "  trim3r plan --ram 256K\n"
        "  trim3r plan --arena 2M --time 100ms\n"
        "  trim3r plan --arena 2M --time 0.5s --head small --machine board.json\n"
        "  trim3r plan --size 96x96 --gaussians 900 --clusters 64 --svg arena.svg\n"
        "  trim3r plan --size 64x64 --gaussians 400 --head tiny --header planned.h\n"
        "  trim3r plan --size 320x240 --views 4 --gaussians 4000 --stream\n"
        "  trim3r plan --size 256x256 --gaussians 13107 --json\n\n"
        "A list has one row for each choice of head, budget and passes that no other beats in loss, bytes and time. "
        "--head, --gaussians, --keep and --refine fix theirs. The expected loss is against the best settings "
        "measured, on training scenes at 256x256: it orders settings and predicts no scene. Operations are "
        "instructions of plain C.\n\n"
        "--ram knows 128K, 192K, 256K, 512K, 1M or 4M of RAM, or the next smaller of these: arena, rows of a "
        "frame, "
        "picture, stack and the program's own variables together.",
    .children = children,
};

static void print_json(const t3r_config *config, const t3r_plan_info *plan, const work_counts *work,
                       const work_prices *prices)
{
    cJSON *root = cJSON_CreateObject();
    json_add_integer(root, "width", config->width);
    json_add_integer(root, "height", config->height);
    json_add_integer(root, "views", config->views);
    json_add_integer(root, "gaussians", config->gaussians);
    json_add_integer(root, "clusters", t3r_cluster_count(config));
    json_add_integer(root, "threads", config->workers);
    cJSON_AddStringToObject(root, "depth", t3r_depth_name(config->depth));
    json_add_integer(root, "head_column_bytes", config->head_column_bytes);
    json_add_integer(root, "min_bytes", (int64_t)plan->min_bytes);
    json_add_integer(root, "arena_bytes", (int64_t)plan->bytes);
    json_add_integer(root, "most_blends", (int64_t)plan->most_blends);
    if (work != NULL) {
        work_table_add_json(root, work, prices);
    }
    cJSON *buffers = cJSON_AddArrayToObject(root, "buffers");
    for (uint32_t i = 0; i < plan->buffer_count; i++) {
        const t3r_plan_buffer *b = &plan->buffers[i];
        cJSON *item = cJSON_CreateObject();
        cJSON_AddStringToObject(item, "name", b->name);
        json_add_integer(item, "offset", (int64_t)b->offset);
        json_add_integer(item, "bytes", (int64_t)b->bytes);
        cJSON_AddStringToObject(item, "first", t3r_stage_name(b->first));
        cJSON_AddStringToObject(item, "last", t3r_stage_name(b->last));
        cJSON_AddItemToArray(buffers, item);
    }
    json_print(root);
}

static void print_table(const t3r_plan_info *plan, bool markdown)
{
    const char *head = markdown ? "| %s | %s | %s | %s | %s |\n" : "%-28s %11s %11s %-13s %s\n";
    printf(head, "buffer", "bytes", "offset", "first stage", "last stage");
    if (markdown) {
        puts("|---|---:|---:|---|---|");
    }
    for (uint32_t i = 0; i < plan->buffer_count; i++) {
        const t3r_plan_buffer *b = &plan->buffers[i];
        if (b->bytes == 0) {
            continue;
        }
        printf(markdown ? "| %s | %zu | %zu | %s | %s |\n" : "%-28s %11zu %11zu %-13s %s\n", b->name, b->bytes,
               b->offset, t3r_stage_name(b->first), t3r_stage_name(b->last));
    }
    const char *total = markdown ? "| **%s** | **%zu** | | | |\n" : "%-28s %11zu\n";
    printf(total, "arena, at least", plan->min_bytes);
    printf(total, "arena, full speed", plan->bytes);
    if (!markdown) { /* it has no bytes */
        printf("\nsplats blended into tiles, at most %" PRIu64 " a view\n", plan->most_blends);
    }
}

/* Writes the picture and the header that are asked for. */
static int write_files(const plan_options *o, const t3r_config *config, const t3r_plan_info *plan, const char *head)
{
    const char *const paths[] = {o->svg, o->header};
    for (int i = 0; i < 2; i++) {
        t3r_whole_file file;
        char error[512] = "";
        if (paths[i] == NULL) {
            continue;
        }
        if (whole_file_begin(&file, paths[i], error, sizeof error) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s", error);
        }
        if (paths[i] == o->svg) {
            plan_picture_write(file.stream, plan);
        } else {
            plan_code_header(file.stream, config, plan, head);
        }
        if (t3r_whole_file_commit(&file, NULL, error, sizeof error) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s", error);
        }
    }
    return CLI_OK;
}

/* Lowers the budget to what an arena of `bytes` can hold. */
static int lower_budget(t3r_config *config, uint64_t bytes)
{
    if (config->gaussians == 0) {
        uint64_t points = (uint64_t)config->width * config->height * (config->views > 0 ? config->views : 1);
        config->gaussians = config->max_gaussians = points < T3R_MAX_GAUSSIANS ? (uint32_t)points : T3R_MAX_GAUSSIANS;
    }
    t3r_status status = t3r_plan_within((size_t)bytes, config);
    if (status != T3R_ERR_ARENA) {
        return status == T3R_OK ? CLI_OK : reconstruction_error(status, "settings", config, 0);
    }
    t3r_plan_info plan;
    config->gaussians = config->max_gaussians = 1;
    (void)t3r_plan(config, &plan); /* the configuration is a valid one: its arena alone is too large */
    return cli_error(CLI_BUDGET_TOO_SMALL, "%" PRIu64 " bytes hold no Gaussian: one needs an arena of %zu", bytes,
                     plan.min_bytes);
}

/* Prints the arena of one configuration and its work. */
static int print_plan(const plan_options *o, const t3r_config *config, const chosen_head *head)
{
    t3r_plan_info plan;
    work_counts counts;
    const work_counts *work = config->stream == 0 ? &counts : NULL; /* of builds alone */
    machine m;
    t3r_status status = t3r_plan(config, &plan);
    if (status == T3R_OK && work != NULL) {
        const size_t bytes = o->within != 0 ? (size_t)o->within : plan.bytes;
        status = work_count(config, bytes, head->weights, &counts);
    }
    if (status != T3R_OK) {
        return reconstruction_error(status, "settings", config, 0);
    }
    const work_prices *prices = o->fitting.machine != NULL ? &m.prices : NULL;
    int code = prices != NULL ? fitting_machine(&o->fitting, config->workers, &m) : CLI_OK;
    if (code == CLI_OK) {
        code = write_files(o, config, &plan, head->name);
    }
    if (code != CLI_OK) {
        return code;
    }
    if (o->json) {
        print_json(config, &plan, work, prices);
        return CLI_OK;
    }
    if (o->within != 0) {
        printf("%" PRIu32 " Gaussians fit into %" PRIu64 " bytes\n\n", config->gaussians, o->within);
    }
    print_table(&plan, o->markdown);
    if (!o->markdown && work != NULL) {
        putchar('\n');
        work_table_print(work, prices);
    }
    return CLI_OK;
}

int command_plan(int argc, char **argv)
{
    plan_options o = {.config = unset()};
    file_options_parse(&argp, argc, argv, &o);
    if (o.ram != 0) {
        return ram_print(o.ram, o.json);
    }

    t3r_config config = o.config;
    if (config.render_width == 0) {
        config.render_width = config.width;
        config.render_height = config.height;
    }
    if (lists(&o)) {
        return fitting_list(&o.fitting, &config, o.head, o.json, o.markdown);
    }
    if (config.refine == CHOICES_ANY_REFINE) {
        config.refine = T3R_DEFAULT_REFINE;
    }
    chosen_head head;
    int code = chosen_head_open(&head, o.head != NULL ? o.head : CHOSEN_HEAD_DEFAULT);
    if (code != CLI_OK) {
        return code;
    }
    chosen_head_configure(&head, &config);
    code = o.within != 0 ? lower_budget(&config, o.within) : CLI_OK;
    code = code == CLI_OK ? print_plan(&o, &config, &head) : code;
    chosen_head_close(&head);
    return code;
}
