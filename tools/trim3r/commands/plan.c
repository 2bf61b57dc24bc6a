/* trim3r plan: what an arena holds, before anything runs. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/file_options.h"
#include "reconstruction/reconstruction_error.h"
#include "cli/json_output.h"
#include "cli/option_values.h"
#include "cli/processor_options.h"
#include "reconstruction/head_option.h"
#include "pictures/plan_picture.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/settings.h"
#include "cli/whole_file.h"

typedef struct plan_options {
    t3r_config config; /* but for the head; a render_width of 0 is the working size */
    uint64_t within;   /* bytes of the arena; 0 = as many as it takes */
    bool json, markdown;
    const char *svg, *head;
} plan_options;

enum {
    KEY_SIZE = 0x1000,
    KEY_VIEWS,
    KEY_GAUSSIANS,
    KEY_WITHIN,
    KEY_RENDER,
    KEY_KEEP,
    KEY_THREADS,
    KEY_SVG,
    KEY_MARKDOWN,
    KEY_JSON
};

static const struct argp_option options[] = {
    {"size", KEY_SIZE, "WxH", 0, "working size of the context views (needed)", 0},
    {"views", KEY_VIEWS, "N", 0, "number of context views, 0..16; 0 = an arena that only renders (2)", 0},
    {"gaussians", KEY_GAUSSIANS, "Z", 0, "budget (needed, or --within)", 0},
    {"within", KEY_WITHIN, "BYTES[K|M]", 0,
     "bytes of an arena, for the largest budget that it can hold, at most --gaussians (all points of the views)", 0},
    {"render", KEY_RENDER, "WxH", 0, "largest picture to draw (the working size)", 0},
    {"keep-analysis", KEY_KEEP, NULL, 0, "keep the analysis after the build, so that the budget can change", 0},
    {"threads", KEY_THREADS, "N|all", 0,
     "number of threads that share the arena's work, 1..16, or all: one for each processor (1)", 0},
    {"svg", KEY_SVG, "FILE", OPTION_WRITES(FILE_SVG), "picture of the arena to write: stages across, bytes upwards", 0},
    {"markdown", KEY_MARKDOWN, NULL, 0, "print the table in Markdown", 0},
    {"json", KEY_JSON, NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    plan_options *o = state->input;
    t3r_config *c = &o->config;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = c;
        state->child_inputs[1] = &o->head;
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
    case KEY_WITHIN:
        o->within = option_bytes(state, "within", arg);
        return 0;
    case KEY_RENDER:
        option_size(state, "render", arg, 1, &c->render_width, &c->render_height);
        return 0;
    case KEY_KEEP:
        c->keep_analysis = 1;
        return 0;
    case KEY_THREADS:
        c->workers = option_threads(state, arg);
        return 0;
    case KEY_SVG:
        o->svg = arg;
        return 0;
    case KEY_MARKDOWN:
        o->markdown = true;
        return 0;
    case KEY_JSON:
        o->json = true;
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, arg, NULL, 0);
        return 0;
    case ARGP_KEY_END:
        if (c->width == 0 || (c->gaussians == 0 && o->within == 0)) {
            argp_error(state, "%s is missing", c->width == 0 ? "--size WxH" : "--gaussians Z or --within BYTES");
        } else if (o->json && o->markdown) {
            argp_error(state, "--json and --markdown exclude each other");
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{.argp = &settings_argp}, {.argp = &head_argp}, {0}};
static const struct argp argp = {
    .options = options,
    .parser = parse,
    .doc = "Print an arena's buffers, the least bytes that work, and the bytes for full speed."
           "\vExamples:\n"
           "  trim3r plan --size 256x256 --views 2 --gaussians 13107\n"
           "  trim3r plan --size 96x96 --within 512K\n"
           "  trim3r plan --size 96x96 --gaussians 900 --clusters 64 --svg arena.svg\n"
           "  trim3r plan --size 256x256 --gaussians 13107 --json",
    .children = children,
};

static void print_json(const t3r_config *config, const t3r_plan_info *plan)
{
    cJSON *root = cJSON_CreateObject();
    json_add_integer(root, "width", config->width);
    json_add_integer(root, "height", config->height);
    json_add_integer(root, "views", config->views);
    json_add_integer(root, "gaussians", config->gaussians);
    json_add_integer(root, "clusters", config->clusters);
    json_add_integer(root, "threads", config->workers);
    cJSON_AddStringToObject(root, "depth", t3r_depth_name(config->depth));
    json_add_integer(root, "head_column_bytes", config->head_column_bytes);
    json_add_integer(root, "min_bytes", (int64_t)plan->min_bytes);
    json_add_integer(root, "arena_bytes", (int64_t)plan->bytes);
    json_add_integer(root, "most_blends", (int64_t)plan->most_blends);
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
    const char *head = markdown ? "| %s | %s | %s | %s | %s |\n" : "%-30s %12s %12s  %-13s  %s\n";
    printf(head, "buffer", "bytes", "offset", "first stage", "last stage");
    if (markdown) {
        puts("|---|---:|---:|---|---|");
    }
    for (uint32_t i = 0; i < plan->buffer_count; i++) {
        const t3r_plan_buffer *b = &plan->buffers[i];
        if (b->bytes == 0) {
            continue;
        }
        printf(markdown ? "| %s | %zu | %zu | %s | %s |\n" : "%-30s %12zu %12zu  %-13s  %s\n", b->name, b->bytes,
               b->offset, t3r_stage_name(b->first), t3r_stage_name(b->last));
    }
    const char *total = markdown ? "| **%s** | **%zu** | | | |\n" : "%-30s %12zu\n";
    printf(total, "arena, at least", plan->min_bytes);
    printf(total, "arena, full speed", plan->bytes);
    if (!markdown) { /* it has no bytes */
        printf("\nsplats blended into tiles, at most %" PRIu64 " a view\n", plan->most_blends);
    }
}

static int write_svg(const char *path, const t3r_plan_info *plan)
{
    whole_file file;
    char error[512] = "";
    if (whole_file_begin(&file, path, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    plan_picture_write(file.stream, plan);
    return whole_file_commit(&file, NULL, error, sizeof error) == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "%s", error);
}

/* To what an arena of so many bytes can hold. */
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

int command_plan(int argc, char **argv)
{
    plan_options o = {.config = t3r_default_config(0, 0, 2, 0), .head = CHOSEN_HEAD_DEFAULT};
    file_options_parse(&argp, argc, argv, &o);

    t3r_config config = o.config;
    chosen_head head;
    int code = chosen_head_open(&head, o.head);
    if (code != CLI_OK) {
        return code;
    }
    chosen_head_configure(&head, &config);
    chosen_head_close(&head);
    if (config.render_width == 0) {
        config.render_width = config.width;
        config.render_height = config.height;
    }
    if (o.within != 0 && (code = lower_budget(&config, o.within)) != CLI_OK) {
        return code;
    }
    t3r_plan_info plan;
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK) {
        return reconstruction_error(status, "settings", &config, 0);
    }
    if (o.svg != NULL && (code = write_svg(o.svg, &plan)) != CLI_OK) {
        return code;
    }
    if (o.json) {
        print_json(&config, &plan);
    } else {
        if (o.within != 0) {
            printf("%" PRIu32 " Gaussians fit into %" PRIu64 " bytes\n\n", config.gaussians, o.within);
        }
        print_table(&plan, o.markdown);
    }
    return CLI_OK;
}
