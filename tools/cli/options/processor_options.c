/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/options/processor_options.h"

#include <string.h>

#include "cli/options/option_values.h"
#include "host/cpu.h"
#include "trim3r.h"

enum { KEY_THREADS = 0x180, KEY_CPU_MASK };

static const struct argp_option options[] = {
    {NULL, 0, NULL, 0, "Without effect on the result:", PROCESSOR_GROUP},
    {"threads", KEY_THREADS, "N|all", 0, "number of threads, 1..16, or all: one for each processor (1)", 0},
    {"cpu-mask", KEY_CPU_MASK, "MASK", 0,
     "vector extensions of the processor to use: all (default), none, names like avx2,vnni or a number", 0},
    {0},
};

processor_options processor_defaults(void)
{
    return (processor_options){.threads = 1, .cpu = t3r_cpu_features()};
}

uint32_t option_threads(struct argp_state *state, const char *text)
{
    if (strcmp(text, "all") == 0) {
        return t3r_cpu_count();
    }
    return option_number(state, "threads", text, 1, T3R_MAX_WORKERS);
}

static uint32_t parse_mask(struct argp_state *state, const char *text)
{
    uint32_t mask = 0;
    if (!t3r_cpu_parse_mask(text, &mask)) {
        argp_error(state, "--cpu-mask takes all, none, names like avx2,vnni or a number, not '%s'", text);
    }
    return t3r_cpu_features() & mask;
}

static error_t parse(int key, char *arg, struct argp_state *state)
{
    processor_options *o = state->input;
    switch (key) {
    case KEY_THREADS:
        o->threads = option_threads(state, arg);
        return 0;
    case KEY_CPU_MASK:
        o->cpu = parse_mask(state, arg);
        return 0;
    default:
        return ARGP_ERR_UNKNOWN;
    }
}

const struct argp processor_argp = {.options = options, .parser = parse};
