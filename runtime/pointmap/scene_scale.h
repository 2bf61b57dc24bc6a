/* SPDX-License-Identifier: Apache-2.0 */
/* The scale of a scene: its median measured depth lies in [1, 2) scene units (core/scene_frame.h). */
#ifndef T3R_SCENE_SCALE_H
#define T3R_SCENE_SCALE_H

#include <stdint.h>

#include "pointmap_work.h"
#include "state/views.h"

/* Chooses the exponent of the frame from the views' measured depths. Returns T3R_ERR_NO_DEPTH when there are none. */
t3r_status t3r_scene_exponent(const t3r_view *views, uint32_t count, const t3r_pointmap_work *work, int32_t *exponent);

/* Chooses the exponent like t3r_scene_exponent() and computes the median depth in that frame. */
t3r_status t3r_scene_scale_choose(const t3r_view *views, uint32_t count, const t3r_pointmap_work *work,
                                  int32_t *exponent, int32_t *median_q20);

#endif
