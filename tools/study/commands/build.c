/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r build, also by a rival. */
#include "study/commands/commands.h"

#include <argp.h>

#include "cli/options/file_options.h"
#include "study/rivals/options.h"
#include "trim3r/commands/build.h"

enum { KEY_METHOD = 0x400 };

static const struct argp_option options[] = {
    {"method", KEY_METHOD, "METHOD", 0, METHOD_HELP, 10},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    build_options *o = state->input;
    switch (key) {
    case ARGP_KEY_INIT:
        state->child_inputs[0] = o;
        state->child_inputs[1] = &o->settings;
        return 0;
    case KEY_METHOD:
        o->settings.method = option_method(state, "method", arg);
        return 0;
    case ARGP_KEY_END:
        rival_check_settings(state, &o->settings, &o->settings.method, 1);
        if (o->profile && o->settings.method != &method_trim3r) {
            argp_error(state, "--profile belongs to the method trim3r, which has stages");
        }
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

static const struct argp_child children[] = {{.argp = &build_argp}, {.argp = &rival_argp}, {0}};
static const struct argp argp = {.options = options, .parser = parse, .children = children};

int command_build_by_method(int argc, char **argv)
{
    build_options o;
    build_defaults(&o);
    file_options_parse(&argp, argc, argv, &o);
    return build_run(&o);
}
