/* SPDX-License-Identifier: Apache-2.0 */
#include "study/rivals/options.h"

#include <string.h>

#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "reconstruction/options/option_names.h"
#include "study/rivals/tuning/rounds.h"

#define ITERATIONS_MOST 100000u

enum { KEY_ITERATIONS = 0x300, KEY_ROUNDS, KEY_START, KEY_RATES, KEY_MASK_HEAD };

static const method *named(struct argp_state *state, const char *option, list_word name)
{
    const method *m = method_named(name);
    if (m == NULL) {
        argp_error(state,
                   "--%s: '%.*s' is not a method; there are trim3r, random, eagles, lightgaussian, pup, efficientgs, "
                   "each also with +finetune or +head",
                   option, (int)name.length, name.text);
    }
    return m;
}

const method *option_method(struct argp_state *state, const char *option, const char *text)
{
    return named(state, option, (list_word){text, strlen(text)});
}

void option_methods(struct argp_state *state, const char *option, const char *text, const method *methods[METHOD_COUNT],
                    uint32_t *count)
{
    *count = 0;
    for (list_word w = word_first(text); w.text != NULL; w = word_next(w)) {
        const method *m = named(state, option, w);
        for (uint32_t i = 0; i < *count; i++) {
            if (methods[i] == m) {
                argp_error(state, "--%s names %s twice", option, m->name);
            }
        }
        methods[(*count)++] = m;
    }
}

void rival_check_settings(struct argp_state *state, const reconstruction_options *settings,
                          const method *const methods[], uint32_t count)
{
    for (uint32_t i = 0; i < count; i++) {
        const bool ranks = method_ranks_for_head(methods[i]);
        if (settings->points_of != NULL && ranks) {
            argp_error(state,
                       "--prune takes no rival with +head: which pixels a file's Gaussians came from is not known");
        } else if (settings->mask_head != NULL && !ranks) {
            argp_error(state, "--mask-head belongs to rivals with +head, not to %s", methods[i]->name);
        }
    }
}

static const struct argp_option options[] = {
    {NULL, 0, NULL, 0, "Rivals:", 15},
    {"finetune-iterations", KEY_ITERATIONS, "N", 0, "iterations of the methods with +finetune, 1..100000 (200)", 0},
    {"finetune-rounds", KEY_ROUNDS, "N", 0,
     "rounds in which rivals prune and fine-tune, 1..16 (as published: pup 2, efficientgs 3, eagles 5, others 1)", 0},
    {"finetune-start", KEY_START, "neighbours|pruned", 0,
     "widths that fine-tuning starts from: the distances to neighbours, as in 3D Gaussian Splatting, or "
     "what pruning left (neighbours)",
     0},
    {"finetune-rates", KEY_RATES, "tuned|published", 0,
     "rates of fine-tuning: tuned on training scenes for few iterations, or those of 3D Gaussian Splatting (tuned)", 0},
    /* CHOSEN_HEAD_VALUES, shortened to 79 columns of help */
    {"mask-head", KEY_MASK_HEAD, "tiny|small|H.t3w|analytic|none", OPTION_READS | OPTION_OR_WORD,
     "head whose unpruned scene rivals with +head rank (the one of --head); so --head can be one that was retrained "
     "for their points",
     0},
    {0},
};

/* Returns whether the value is the second of two words. */
static bool option_second(struct argp_state *state, const char *option, const char *text, const char *first,
                          const char *second)
{
    if (strcmp(text, first) != 0 && strcmp(text, second) != 0) {
        argp_error(state, "--%s takes %s or %s, not '%s'", option, first, second, text);
    }
    return strcmp(text, second) == 0;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    reconstruction_options *o = state->input;
    switch (key) {
    case KEY_ITERATIONS:
        o->finetune.iterations = option_number(state, "finetune-iterations", arg, 1, ITERATIONS_MOST);
        return 0;
    case KEY_ROUNDS:
        o->finetune.rounds = option_number(state, "finetune-rounds", arg, 1, ROUNDS_MOST);
        return 0;
    case KEY_START:
        o->finetune.pruned_widths = option_second(state, "finetune-start", arg, "neighbours", "pruned");
        return 0;
    case KEY_RATES:
        o->finetune.published_rates = option_second(state, "finetune-rates", arg, "tuned", "published");
        return 0;
    case KEY_MASK_HEAD:
        o->mask_head = option_head(state, "mask-head", arg);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp rival_argp = {
    .options = options,
    .parser = parse,
    .doc = "\vThe rivals rank the Gaussians that --head and --refine make of all points, by the score of their papers "
           "over the context views. They draw the best ones unchanged. With --prune they rank those of the "
           "file.\n"
           "  random         a random choice, by --seed\n"
           "  eagles         influence: the sum of blend weights\n"
           "  lightgaussian  opacity x transmittance x volume\n"
           "  pup            second-order sensitivity to place and scale\n"
           "  efficientgs    dominance: in most pixels\n"
           "  +finetune      N iterations of Adam on all parameters, in rounds of pruning\n"
           "  +head          --head makes new Gaussians of the points they came from\n",
};
