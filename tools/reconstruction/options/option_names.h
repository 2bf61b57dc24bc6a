/* Values of options that name a head, a source of depth or a preset; cli/option_values.h reads the others. */
#ifndef TRIM3R_TOOLS_OPTION_NAMES_H
#define TRIM3R_TOOLS_OPTION_NAMES_H

#include <argp.h>
#include <stdint.h>

#include "trim3r.h"

/* A head's name, or a path that ends as weight files do. */
const char *option_head(struct argp_state *state, const char *option, const char *text);
/* A source of depth by its name. */
t3r_depth option_depth(struct argp_state *state, const char *option, const char *text);
/* How much work a build is worth, by its name: the settings and the head for it. */
void option_preset(struct argp_state *state, const char *option, const char *text, t3r_config *config,
                   const char **head);

#endif
