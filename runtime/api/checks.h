/* SPDX-License-Identifier: Apache-2.0 */
/* What callers, files and copied arenas bring is checked by these, and nowhere deeper. */
#ifndef T3R_CHECKS_H
#define T3R_CHECKS_H

#include <stdbool.h>

#include "state/state.h"
#include "trim3r.h"

bool t3r_is_scene_frame(const t3r_scene_frame *frame);
bool t3r_is_gaussian(const t3r_gaussian *gaussian);

/* Whether every field is in the range that the configuration leaves it. */
bool t3r_is_build(const t3r_config *config, const t3r_build *build);

/* Whether the weights are bound that this head needs. */
bool t3r_has_head(const t3r_runtime *rt, t3r_head head);

#endif
