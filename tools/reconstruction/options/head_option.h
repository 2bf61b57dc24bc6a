/* The option --head of the commands that make Gaussians; its help names every head of the runtime. */
#ifndef TRIM3R_TOOLS_HEAD_OPTION_H
#define TRIM3R_TOOLS_HEAD_OPTION_H

#include <argp.h>

/* Each parent's parser passes a const char ** in state->child_inputs[]: it receives a text that
 * chosen_head_is_one(). */
extern const struct argp head_argp;

#endif
