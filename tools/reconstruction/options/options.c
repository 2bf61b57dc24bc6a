/* SPDX-License-Identifier: Apache-2.0 */
/* The options that build, eval, replay and bench share. */
#include "reconstruction/reconstruction.h"

#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "reconstruction/options/head_option.h"
#include "reconstruction/options/option_names.h"
#include "reconstruction/options/settings.h"

enum { KEY_GAUSSIANS = 256, KEY_KEEP, KEY_CONTEXT, KEY_MAX_LOSS, KEY_MIN_PSNR, KEY_WORKING, KEY_ARENA, KEY_PRESET };

static const struct argp_option settings[] = {
    {NULL, 0, NULL, 0, "Settings:", 20},
    {"preset", KEY_PRESET, "fast|balanced|best", 0,
     "head and refinement for an amount of work (balanced); later settings override it", 0},
    {"auto", OPTION_TO(reconstruction_options, automatic), NULL, 0,
     "take no more Gaussians than the scene needs: the fewest that stay within --max-loss, as measured halfway between "
     "the context views, and at most the budget (all valid points); it needs memory and time for a scene of all",
     0},
    {"max-loss", KEY_MAX_LOSS, "DB", 0,
     "decibels that --auto may lose on new views, against a scene of all valid points; 0.01..10 (0.5)", 0},
    {"min-psnr", KEY_MIN_PSNR, "DB", 0,
     "take the fewest Gaussians that draw each context view at so many decibels, measured over all pixels that its "
     "lens "
     "shows, and at most the budget (all valid points); 0.01..100",
     0},
    {"importance", OPTION_TO(reconstruction_options, importance), "PNG,PNG,...",
     OPTION_READS | OPTION_LIST | OPTION_FOLDER,
     "importance of each pixel, for --allocate given: a grey picture for each context view, in their order and of the "
     "working size, or a folder with <frame>.png; the brightest points are retained; 8-bit pictures are spread evenly "
     "within a level",
     0},
    {"working", KEY_WORKING, "WxH", 0, "working size of the context views (the recording's)", 0},
    {"arena", KEY_ARENA, "BYTES[K|M|G]|min|full", 0,
     "bytes of memory of the runtime; min is the least that works, full the most that helps (full)", PROCESSOR_GROUP},
    {0},
};

void reconstruction_parse_arena(struct argp_state *state, const char *text, reconstruction_options *o)
{
    if (strcmp(text, "full") == 0) {
        o->arena = ARENA_FULL;
    } else if (strcmp(text, "min") == 0) {
        o->arena = ARENA_MIN;
    } else {
        if (!bytes_of_text(text, &o->arena_bytes)) {
            argp_error(state,
                       "--arena takes a number of bytes, optionally followed by K, M or G, or min or full, not '%s'",
                       text);
        }
        o->arena = ARENA_BYTES;
    }
}

void reconstruction_parse_context(struct argp_state *state, const char *text, reconstruction_options *o)
{
    o->context_kind = strcmp(text, "all") == 0    ? CONTEXT_ALL
                      : strcmp(text, "auto") == 0 ? CONTEXT_AUTO
                                                  : CONTEXT_LISTED;
    o->context_count = 0;
    if (o->context_kind == CONTEXT_LISTED) {
        option_frames(state, "context", text, o->context, &o->context_count);
    }
}

bool reconstruction_names_context(const reconstruction_options *o)
{
    return o->context_count > 0 || o->context_kind != CONTEXT_LISTED;
}

static void check_settings(struct argp_state *state, reconstruction_options *o)
{
    if ((o->config.allocate == T3R_ALLOCATE_GIVEN) != (o->importance != NULL)) {
        argp_error(state, "--allocate given and --importance belong together");
    }
    if (o->points_of != NULL) {
        if (o->config.depth != T3R_DEPTH_SENSOR) {
            argp_error(state, "--depth belongs to a recording's own points, not to --prune");
        }
        o->config.fit_passes = 0; /* means of Gaussians lie off the surface, and views always disagree about them */
        o->config.guess = 0;      /* where the scene has nothing, there is nothing */
    }
    if (o->max_loss > 0 && !o->automatic) {
        argp_error(state, "--max-loss belongs to --auto");
    }
    if (o->min_psnr > 0 && o->automatic) {
        argp_error(state, "--auto and --min-psnr exclude each other");
    }
    if (!o->automatic) {
        return;
    }
    if (o->config.refine == 0) {
        argp_error(state, "--auto measures where refinement does: it needs --refine 1 or more");
    }
    if (o->max_loss <= 0) {
        o->max_loss = RECONSTRUCTION_MAX_LOSS;
    }
}

static error_t parse_setting(int key, char *arg, struct argp_state *state)
{
    reconstruction_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = &o->config;
        state->child_inputs[1] = &o->processor;
        state->child_inputs[2] = &o->head;
        return 0;
    case KEY_WORKING:
        option_size(state, "working", arg, T3R_MIN_SIDE, &o->config.width, &o->config.height);
        return 0;
    case KEY_ARENA:
        reconstruction_parse_arena(state, arg, o);
        return 0;
    case KEY_PRESET:
        option_preset(state, "preset", arg, &o->config, &o->head);
        return 0;
    case KEY_MAX_LOSS:
        o->max_loss = option_decimal(state, "max-loss", arg, 0.01, 10);
        return 0;
    case KEY_MIN_PSNR:
        o->min_psnr = option_decimal(state, "min-psnr", arg, 0.01, 100);
        return 0;
    case ARGP_KEY_END:
        check_settings(state, o);
        return 0;
    default:
        return option_field(key, arg, state);
    }
}

static const struct argp_child settings_children[] = {
    {.argp = &settings_argp}, {.argp = &processor_argp}, {.argp = &head_argp}, {0}};

const struct argp reconstruction_settings_argp = {
    .options = settings, .parser = parse_setting, .children = settings_children};

static const struct argp_option budget[] = {
    {NULL, 0, NULL, 0, "Views and budget:", 10},
    {"context", KEY_CONTEXT, "LIST|all|auto", 0,
     "frames that the scene is made of, 1..16: 0,2 or 0-3 or 0:11:2; all; or auto, sharp ones that together see most, "
     "from different places (the first two)",
     0},
    {"gaussians", KEY_GAUSSIANS, "Z", 0,
     "number of Gaussians, such as 13107 or 10k: exactly Z, or all valid points if there are fewer", 0},
    {"keep", KEY_KEEP, "P%", 0, "percent of the valid points to retain, rounded half up to a number", 0},
    {0},
};

static error_t parse_budget(int key, char *arg, struct argp_state *state)
{
    reconstruction_options *o = state->input;
    uint32_t count;
    switch (key) {
    case KEY_CONTEXT:
        reconstruction_parse_context(state, arg, o);
        return 0;
    case KEY_GAUSSIANS:
        o->gaussians = option_number(state, "gaussians", arg, 1, T3R_MAX_GAUSSIANS);
        return 0;
    case KEY_KEEP:
        option_keep(state, arg, &o->keep_percent, 1, &count);
        return 0;
    case ARGP_KEY_END:
        if (o->gaussians != 0 && o->keep_percent > 0) {
            argp_error(state, "--gaussians and --keep exclude each other");
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp reconstruction_budget_argp = {.options = budget, .parser = parse_budget};

/* ---- both ------------------------------------------------------------------------------------------------------ */

static error_t parse_both(int key, char *arg, struct argp_state *state)
{
    (void)arg;
    if (key == ARGP_KEY_INIT) {
        state->child_inputs[0] = state->child_inputs[1] = state->input;
        return 0;
    }
    return ARGP_ERR_UNKNOWN;
}

static const struct argp_child both[] = {
    {.argp = &reconstruction_budget_argp}, {.argp = &reconstruction_settings_argp}, {0}};

const struct argp reconstruction_argp = {.parser = parse_both, .children = both};
