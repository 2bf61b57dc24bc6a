/* SPDX-License-Identifier: Apache-2.0 */
/* Decides whether a build that follows another (t3r_config.warm) may keep its frame. */
#ifndef T3R_SAME_FRAME_H
#define T3R_SAME_FRAME_H

#include <stdbool.h>

#include "state/state.h"

/* Whether the added views, which have these planes, still need the scale of the runtime's frame, and each camera is
 * within 512 scene units of its origin along every axis. */
bool t3r_is_in_frame(const t3r_runtime *rt, const t3r_view *views);

#endif
