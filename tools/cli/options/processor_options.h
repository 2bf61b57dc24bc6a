/* The options of every command that runs stages: how much of the processor they may use. Results stay as they are. */
#ifndef TRIM3R_TOOLS_PROCESSOR_OPTIONS_H
#define TRIM3R_TOOLS_PROCESSOR_OPTIONS_H

#include <argp.h>
#include <stdint.h>

typedef struct processor_options {
    uint32_t threads; /* 1..T3R_MAX_WORKERS */
    uint32_t cpu;     /* T3R_CPU_...: what the processor has, less what --cpu-mask leaves out */
} processor_options;

#define PROCESSOR_GROUP 30 /* of these options and of their like in --help */

/* One thread, every vector extension of this processor. */
processor_options processor_defaults(void);

/* The value of --threads: a number, or the processors of this machine for `all`. */
uint32_t option_threads(struct argp_state *state, const char *text);

/* --threads, --cpu-mask. Each parent's parser hands a processor_options * on in state->child_inputs[]. */
extern const struct argp processor_argp;

#endif
