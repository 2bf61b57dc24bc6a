/* Values of options that name a head, a source of depth or a preset; cli/option_values.h reads the others. */
#ifndef TRIM3R_TOOLS_OPTION_NAMES_H
#define TRIM3R_TOOLS_OPTION_NAMES_H

#include <argp.h>
#include <stdint.h>

#include "trim3r.h"

/* Returns a head's name, or a path with the suffix of weight files. */
const char *option_head(struct argp_state *state, const char *option, const char *text);
/* Returns a source of depth by its name. */
t3r_depth option_depth(struct argp_state *state, const char *option, const char *text);
/* Sets the settings and the head for a named effort, the amount of work of a build. */
void option_preset(struct argp_state *state, const char *option, const char *text, t3r_config *config,
                   const char **head);

#endif
