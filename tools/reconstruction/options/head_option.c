/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/options/head_option.h"

#include <stdint.h>

#include "cli/options/file_options.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/options/option_names.h"

enum { KEY_HEAD = 0x1a0 };

static const struct argp_option options[] = {
    {"head", KEY_HEAD, CHOSEN_HEAD_VALUES, OPTION_READS | OPTION_OR_WORD,
     "head that makes the Gaussians (" CHOSEN_HEAD_DEFAULT ")", 20},
    {0},
};

static error_t parse(int key, char *arg, struct argp_state *state)
{
    if (key != KEY_HEAD) {
        return ARGP_ERR_UNKNOWN;
    }
    *(const char **)state->input = option_head(state, "head", arg);
    return 0;
}

const struct argp head_argp = {.options = options, .parser = parse};
