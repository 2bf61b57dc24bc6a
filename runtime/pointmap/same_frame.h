/* Whether the views of a build that follows another (t3r_config.warm) stand in its frame as well. */
#ifndef T3R_SAME_FRAME_H
#define T3R_SAME_FRAME_H

#include <stdbool.h>
#include <stdint.h>

#include "pointmap_work.h"

/* Whether the frame has the scale that these views would choose, and each camera stands within 512 scene units of its
 * origin along every axis. */
bool t3r_is_in_frame(const t3r_view *views, uint32_t count, const t3r_camera *cameras, const t3r_scene_frame *frame,
                     const t3r_pointmap_work *work);

#endif
