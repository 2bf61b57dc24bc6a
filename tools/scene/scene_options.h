/* SPDX-License-Identifier: Apache-2.0 */
/* The options of the commands that read or write scenes. */
#ifndef TRIM3R_TOOLS_SCENE_OPTIONS_H
#define TRIM3R_TOOLS_SCENE_OPTIONS_H

#include <argp.h>

#include "scene/scene_turn.h"

/* The options of reading a scene; input: the int of flags for scene_file_read(), to which they add. */
extern const struct argp scene_input_argp;

/* Reports a usage error if the path (NULL: none) of `option` ("-o") has no suffix of a scene file that can be
 * written. */
void scene_output_option(struct argp_state *state, const char *option, const char *path);
/* Parses --up: returns the named axis; a usage error for other names. */
scene_up scene_up_option(struct argp_state *state, const char *name);

#endif
