/* The way of the data, from the planes of the context views to the scene. */
#ifndef T3R_PIPELINE_H
#define T3R_PIPELINE_H

#include "state.h"

/* The planes of every view there is room for, as the stages take them; poses only of those added. */
void t3r_views_of(const t3r_runtime *rt, t3r_view views[T3R_MAX_VIEWS]);

/* One frame to the planes of view `index`: image stage and validity plane. */
t3r_status t3r_develop_view(t3r_runtime *rt, uint32_t index, const t3r_frame *frame, const t3r_camera *camera,
                            t3r_camera *undistorted);

/* Depth, pointmap frame, wavelet, superclusters: all that does not depend on the budget. */
t3r_status t3r_analyse(t3r_runtime *rt);
/* Budget and head: the scene. */
t3r_status t3r_build_scene(t3r_runtime *rt);

#endif
