/* SPDX-License-Identifier: Apache-2.0 */
/* Checks of input from callers, files and copied arenas; deeper functions check nothing again. */
#ifndef T3R_CHECKS_H
#define T3R_CHECKS_H

#include <stdbool.h>

#include "state/state.h"
#include "trim3r.h"

bool t3r_is_scene_frame(const t3r_scene_frame *frame);
bool t3r_is_gaussian(const t3r_gaussian *gaussian);

/* Whether every field is in the range that the configuration allows. */
bool t3r_is_build(const t3r_config *config, const t3r_build *build);

/* Whether the weights that this head needs are bound. */
bool t3r_has_head(const t3r_runtime *rt, t3r_head head);

#endif
