/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/options/poses_option.h"

#include "posing/poses_source.h"

enum { KEY_POSES = 0x1b0 };

static const struct argp_option options[] = {
    {"poses", KEY_POSES, POSES_PLACEHOLDER, 0,
     "source of the poses of the context views: given (default), those of the recording; estimate, from features that "
     "views share, with depth where two of them have it; estimate-colour, the same from colour alone",
     20},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    if (key != KEY_POSES) {
        return ARGP_ERR_UNKNOWN;
    }
    if (!poses_named(arg, state->input)) {
        argp_error(state, "--poses does not know '%s'; there are %s", arg, POSES_NAMES);
    }
    return 0;
}

const struct argp poses_argp = {.options = options, .parser = parse};
