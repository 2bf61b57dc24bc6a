/* SPDX-License-Identifier: Apache-2.0 */
/* Options of commands that compare methods. */
#ifndef TRIM3R_TOOLS_RIVALS_OPTIONS_H
#define TRIM3R_TOOLS_RIVALS_OPTIONS_H

#include <argp.h>
#include <stdint.h>

#include "study/rivals/methods.h"

#define METHOD_HELP                                                                                                    \
    "trim3r (default), or a rival: random, eagles, lightgaussian, pup, efficientgs; +finetune after any of them "      \
    "fine-tunes its Gaussians, +head makes new ones of its points"

/* Parse an option's value: a method, or up to METHOD_COUNT different ones separated by commas. */
const method *option_method(struct argp_state *state, const char *option, const char *text);
void option_methods(struct argp_state *state, const char *option, const char *text, const method *methods[METHOD_COUNT],
                    uint32_t *count);

/* Parses --finetune-iterations and --mask-head for a parent that passes reconstruction_options *; its doc describes
 * the rivals. */
extern const struct argp rival_argp;

/* Reports a usage error if the settings do not fit one of the methods. */
void rival_check_settings(struct argp_state *state, const reconstruction_options *settings,
                          const method *const methods[], uint32_t count);

#endif
