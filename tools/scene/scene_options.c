/* SPDX-License-Identifier: Apache-2.0 */
#include "scene/scene_options.h"

#include "scene/scene_file.h"
#include "scene/scene_turn.h"

void scene_output_option(struct argp_state *state, const char *option, const char *path)
{
    char suffixes[SCENE_FILE_SUFFIXES_BYTES];
    if (path != NULL && !scene_file_is_written(path)) {
        argp_error(state, "%s %s: scenes are written as %s", option, path, scene_file_suffixes(suffixes));
    }
}

scene_up scene_up_option(struct argp_state *state, const char *name)
{
    const scene_up up = scene_up_named(name);
    if (up == T3R_UP_UNKNOWN) {
        argp_error(state, "--up takes one of %s, not '%s'", SCENE_UP_NAMES, name);
    }
    return up;
}

/* ---- reading ----------------------------------------------------------------------------------------------------- */

enum { KEY_DROP_INVALID = 0x7000 };

static error_t parse_input(int key, char *argument, struct argp_state *state)
{
    (void)argument;
    int *flags = state->input;
    if (key != KEY_DROP_INVALID) {
        return ARGP_ERR_UNKNOWN;
    }
    *flags |= T3R_SCENE_DROP_INVALID;
    return 0;
}

static const struct argp_option input_options[] = {
    {"drop-invalid", KEY_DROP_INVALID, NULL, 0,
     "leave out and count Gaussians of a scene file that are not valid (such a file is refused)", 0},
    {0},
};

const struct argp scene_input_argp = {.options = input_options, .parser = parse_input};
