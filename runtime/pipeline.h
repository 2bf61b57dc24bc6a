/* SPDX-License-Identifier: Apache-2.0 */
/* The stages from the planes of the context views to the scene. */
#ifndef T3R_PIPELINE_H
#define T3R_PIPELINE_H

#include "budget/importance.h"
#include "state/state.h"
#include "state/views.h"
#include "trim3r.h"

/* Runs the first part of the analysis: finds depth, counts points and chooses the scene's frame. */
t3r_status t3r_find_points(t3r_runtime *rt, t3r_view *views);
/* Runs depth, pointmap, wavelet and superclusters: everything that does not depend on the budget. */
t3r_status t3r_analyse(t3r_runtime *rt);
/* Runs budget, head and refinement. `importance`: for the allocation `given`, NULL for the others. */
t3r_status t3r_build_scene(t3r_runtime *rt, const t3r_view *views, const t3r_build *build,
                           const t3r_importance *importance);

#endif
