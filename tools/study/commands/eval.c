/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r eval with rivals, and with parts of the method removed. */
#include "study/commands/commands.h"

#include <argp.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/text/word_list.h"
#include "evaluation/run.h"
#include "reconstruction/chosen_head.h"
#include "study/ablation/ablation.h"
#include "study/rivals/options.h"

#define ABLATE_KEEPS "60,40,20,10,5"
_Static_assert(EVALUATION_HEADS_MOST + METHOD_COUNT <= EVALUATION_CONTESTANTS_MOST, "no room for methods");
_Static_assert(ABLATIONS_MOST <= EVALUATION_CONTESTANTS_MOST, "no room for ablations");

typedef struct study_options {
    evaluation_options eval;
    const method *methods[METHOD_COUNT]; /* none = trim3r */
    uint32_t method_count;
    bool ablate;
    uint32_t ablations[ABLATIONS_MOST]; /* the given ablations; none = all that apply */
    uint32_t ablation_count;
} study_options;

static void add_ablation(struct argp_state *state, study_options *o, list_word name)
{
    uint32_t found = 0;
    for (const char *known; (known = ablation_name(found)) != NULL; found++) {
        if (word_is(name, known)) {
            break;
        }
    }
    if (ablation_name(found) == NULL) {
        argp_error(state, "--ablate does not know '%.*s'; --help lists what can be ablated", (int)name.length,
                   name.text);
    }
    for (uint32_t i = 0; i < o->ablation_count; i++) {
        if (o->ablations[i] == found) {
            argp_error(state, "--ablate names %s twice", ablation_name(found));
        }
    }
    o->ablations[o->ablation_count++] = found;
}

static void parse_ablations(struct argp_state *state, study_options *o, const char *text)
{
    o->ablate = true;
    o->ablation_count = 0;
    for (list_word w = word_first(text); w.text != NULL; w = word_next(w)) {
        add_ablation(state, o, w);
    }
}

/* Runs before the end of evaluation_argp, because argp ends with the first child. */
static void check(struct argp_state *state, study_options *o)
{
    evaluation_options *eval = &o->eval;
    if (o->ablate && (o->method_count > 0 || eval->head_count > 0)) {
        argp_error(state, "--ablate is of the method trim3r with one --head: it excludes --methods and --heads");
    }
    if (eval->settings.scene != NULL && (o->ablate || o->method_count > 0)) {
        argp_error(state, "--scene is scored as it is: it excludes --ablate and --methods");
    }
    if (o->method_count == 0) {
        o->methods[o->method_count++] = &method_trim3r;
    }
    rival_check_settings(state, &eval->settings, o->methods, o->method_count);
    if (o->ablate && eval->keep_count == 0 && eval->gaussians_count == 0) {
        (void)cli_parse_list_percent(ABLATE_KEEPS, eval->keep, EVALUATION_BUDGETS_MOST, &eval->keep_count);
    }
}

enum { KEY_METHODS = 0x400, KEY_ABLATE };

static error_t parse_own(int key, char *arg, struct argp_state *state)
{
    study_options *o = state->input;
    switch (key) {
    case KEY_METHODS:
        option_methods(state, "methods", arg, o->methods, &o->method_count);
        return 0;
    case KEY_ABLATE:
        parse_ablations(state, o, arg);
        return 0;
    case ARGP_KEY_END:
        check(state, o);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_option own_options[] = {
    {"methods", KEY_METHODS, "M,M,...", 0, METHOD_HELP, 1},
    {"ablate", KEY_ABLATE, "NAME,NAME,...", OPTION_ARG_OPTIONAL,
     "parts to remove, one in each row (all), at 60, 40, 20, 10 and 5 % unless --keep names others; a table of "
     "their effects comes at the end",
     1},
    {0},
};

static const struct argp own_argp = {
    .options = own_options,
    .parser = parse_own,
    .doc = "\v--ablate: each row changes one of the given settings.\n"
           "  full                      nothing\n"
           "  no-adaptation             the head works as if nothing had been pruned; what\n"
           "                            it makes of all points is pruned, then refined\n"
           "  no-mask                   only the network works so; its splats still grow\n"
           "                            with the distance of retained neighbours\n"
           "  random, uniform, paper, pixel   --allocate\n"
           "  random-clusters           SuperClusters exchange their textures at random\n"
           "  paper-random-clusters     the same with --allocate paper\n"
           "  k-5, k-25, k-50, k-100, k-200, k-300, k-400   --clusters\n"
           "  n-5, n-10, n-15, n-20     --allocate paper with that --keep-percent\n"
           "  no-refinement             --refine 0\n"
           "  no-flying, no-redundancy, no-exposure   that switch off\n"
           "The table is Markdown: PSNR (dB) / SSIM, means over the cases of a recording; of several recordings the "
           "mean, each counting once.\n",
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    (void)arg;
    study_options *o = state->input;
    if (key != ARGP_KEY_INIT) {
        return ARGP_ERR_UNKNOWN;
    }
    state->child_inputs[0] = &o->eval;
    state->child_inputs[1] = o;
    state->child_inputs[2] = &o->eval.settings;
    return 0;
}

static const struct argp_child children[] = {
    {.argp = &evaluation_argp}, {.argp = &own_argp}, {.argp = &rival_argp}, {0}};
static const struct argp argp = {.parser = parse, .children = children};

static int add_methods(const study_options *o, evaluation_contestants *chosen)
{
    int code = CLI_OK;
    for (uint32_t m = 0; m < o->method_count && code == CLI_OK; m++) {
        if (o->methods[m] == &method_trim3r) {
            code = evaluation_contestants_add_heads(chosen, o->eval.heads, o->eval.head_count, &o->eval.settings);
        } else {
            reconstruction_options settings = o->eval.settings;
            settings.method = o->methods[m];
            evaluation_contestants_add(chosen, &settings, "");
        }
    }
    return code;
}

static void add_ablated(const study_options *o, evaluation_contestants *chosen, uint32_t ablation)
{
    reconstruction_options settings = o->eval.settings;
    settings.method = &method_trim3r;
    ablation_apply(ablation, &settings);
    evaluation_contestants_add(chosen, &settings, ablation_name(ablation));
}

/* Adds the given ablations, which must apply, or without any given all that apply. */
static int add_ablations(const study_options *o, evaluation_contestants *chosen)
{
    const bool planar = o->eval.planar;
    chosen_head head;
    int code = chosen_head_open(&head, o->eval.settings.head);
    if (code != CLI_OK) {
        return code;
    }
    for (uint32_t a = 0; o->ablation_count == 0 && ablation_name(a) != NULL; a++) {
        if (ablation_applies(a, &head, planar)) {
            add_ablated(o, chosen, a);
        }
    }
    for (uint32_t i = 0; i < o->ablation_count && code == CLI_OK; i++) {
        if (!ablation_applies(o->ablations[i], &head, planar)) {
            code = cli_error(CLI_BAD_USAGE, "--ablate: %s does not apply to %s", ablation_name(o->ablations[i]),
                             planar ? "a single image with this head" : "this head");
        }
        add_ablated(o, chosen, o->ablations[i]);
    }
    chosen_head_close(&head);
    return code;
}

static int choose(const study_options *o, evaluation_contestants *chosen)
{
    if (o->eval.settings.scene != NULL) {
        evaluation_contestants_scene(chosen, &o->eval.settings);
        return CLI_OK;
    }
    return o->ablate ? add_ablations(o, chosen) : add_methods(o, chosen);
}

int command_eval_methods(int argc, char **argv)
{
    study_options o = {.ablate = false};
    evaluation_contestants contestants = {.count = 0};
    evaluation_defaults(&o.eval);
    file_options_parse(&argp, argc, argv, &o);
    if (o.ablate) {
        o.eval.to.table = ablation_table;
    }
    int code = choose(&o, &contestants);
    code = code == CLI_OK ? evaluation_run(&o.eval, &contestants) : code;
    evaluation_options_free(&o.eval);
    return code;
}
