/* The options of every command that runs stages: how much of the processor they use. Results do not depend on them. */
#ifndef TRIM3R_TOOLS_PROCESSOR_OPTIONS_H
#define TRIM3R_TOOLS_PROCESSOR_OPTIONS_H

#include <argp.h>
#include <stdint.h>

typedef struct processor_options {
    uint32_t threads; /* 1..T3R_MAX_WORKERS */
    uint32_t cpu;     /* T3R_CPU_...: the processor's features without those that --cpu-mask excludes */
} processor_options;

#define PROCESSOR_GROUP 30 /* group of these and similar options in --help */

/* Returns one thread and all vector extensions of this processor. */
processor_options processor_defaults(void);

/* Returns the value of --threads: a number, or the processors of this machine for `all`. */
uint32_t option_threads(struct argp_state *state, const char *text);

/* --threads, --cpu-mask. Each parent's parser passes a processor_options * in state->child_inputs[]. */
extern const struct argp processor_argp;

#endif
