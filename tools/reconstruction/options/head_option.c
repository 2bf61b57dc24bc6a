/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/options/head_option.h"

#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>

#include "cli/options/file_options.h"
#include "reconstruction/chosen_head.h"
#include "reconstruction/options/option_names.h"

enum { KEY_HEAD = 0x1a0 };

static const struct argp_option options[] = {
    {"head", KEY_HEAD, "HEAD", OPTION_READS | OPTION_OR_WORD, "head that makes the Gaussians: ", 20},
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

static char *complete_help(int key, const char *text, void *input)
{
    (void)input;
    char names[CHOSEN_HEAD_NAMES_BYTES], *whole;
    const size_t bytes = 512;
    if (key != KEY_HEAD || (whole = malloc(bytes)) == NULL) {
        return (char *)(uintptr_t)text; /* argp frees only a different text */
    }
    snprintf(whole, bytes, "%s%s (" CHOSEN_HEAD_DEFAULT ")", text, chosen_head_names(names));
    return whole;
}

const struct argp head_argp = {.options = options, .parser = parse, .help_filter = complete_help};
