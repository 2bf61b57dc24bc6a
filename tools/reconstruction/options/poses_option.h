/* The option --poses of the commands that build from recordings. */
#ifndef TRIM3R_TOOLS_POSES_OPTION_H
#define TRIM3R_TOOLS_POSES_OPTION_H

#include <argp.h>

/* Each parent's parser passes a poses_source * in state->child_inputs[]. `poses_argp` is the child. */
extern const struct argp poses_argp;

#endif
