/* trim3r build by a rival, too. */
#include "study/commands/commands.h"

#include <argp.h>

#include "cli/files/file_options.h"
#include "study/rivals/options.h"
#include "trim3r/commands/build.h"

enum { KEY_METHOD = 0x400 };

static const struct argp_option own_options[] = {
    {"method", KEY_METHOD, "METHOD", 0, METHOD_HELP, 10},
    {0},
};

static error_t parse_own(int key, char *arg, struct argp_state *state)
{
    build_options *o = state->input;
    switch (key) {
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

static const struct argp own_argp = {
    .options = own_options,
    .parser = parse_own,
    .doc = "\v--method: of the file of --prune, the rivals keep some Gaussians as they are.\n"
           "  trim3r build room.mcap --keep 5% --method pup+finetune -o pup.ply\n"
           "  trim3r build room.mcap --keep 5% --method eagles+head -o eagles.ply\n",
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    (void)arg;
    build_options *o = state->input;
    if (key != ARGP_KEY_INIT) {
        return ARGP_ERR_UNKNOWN;
    }
    state->child_inputs[0] = state->child_inputs[1] = o;
    state->child_inputs[2] = &o->settings;
    return 0;
}

static const struct argp_child children[] = {{.argp = &build_argp}, {.argp = &own_argp}, {.argp = &rival_argp}, {0}};
static const struct argp argp = {.parser = parse, .children = children};

int command_build_by_method(int argc, char **argv)
{
    build_options o;
    build_defaults(&o);
    file_options_parse(&argp, argc, argv, &o);
    return build_run(&o);
}
