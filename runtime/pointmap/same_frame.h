/* Whether the views of a build that follows another (t3r_config.warm) stand in its frame as well. */
#ifndef T3R_SAME_FRAME_H
#define T3R_SAME_FRAME_H

#include <stdbool.h>

#include "state/state.h"

/* Whether the views that were added, whose planes these are, ask for the scale of the runtime's frame, and each camera
 * stands within 512 scene units of its origin along every axis. */
bool t3r_is_in_frame(const t3r_runtime *rt, const t3r_view *views);

#endif
