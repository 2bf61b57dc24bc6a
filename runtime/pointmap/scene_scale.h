/* The scale of a scene: its median measured depth lies in [1, 2) scene units (core/scene_frame.h). */
#ifndef T3R_SCENE_SCALE_H
#define T3R_SCENE_SCALE_H

#include <stdint.h>

#include "state/views.h"

/* Chooses the frame's exponent from the measured depths of the views, and the median depth in that frame.
 * T3R_ERR_NO_DEPTH when no view has a measured depth. */
t3r_status t3r_scene_scale_choose(const t3r_view *views, uint32_t count, int32_t *exponent, int32_t *median_q20);

#endif
