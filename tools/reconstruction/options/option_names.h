/* Values of options that name a head, a source of depth, an effort or methods; the others are in
 * cli/option_values.h. */
#ifndef TRIM3R_TOOLS_OPTION_NAMES_H
#define TRIM3R_TOOLS_OPTION_NAMES_H

#include <argp.h>
#include <stdint.h>

#include "reconstruction/method.h"
#include "trim3r.h"

/* Returns a head's name, or a path with the suffix of weight files. */
const char *option_head(struct argp_state *state, const char *option, const char *text);
/* Returns a source of depth by its name. */
t3r_depth option_depth(struct argp_state *state, const char *option, const char *text);
/* Sets the settings and the head for a named effort, the amount of work of a build. */
void option_effort(struct argp_state *state, const char *option, const char *text, t3r_config *config,
                   const char **head);
/* Parses one to METHOD_COUNT different methods, separated by commas. */
void option_methods(struct argp_state *state, const char *option, const char *text, method_id methods[METHOD_COUNT],
                    uint32_t *count);
#endif
