/* SPDX-License-Identifier: Apache-2.0 */
/* The stages shared by builds and a stream's keyframes, in the order of pipeline.c. Each works on a span of the views,
 * and may read the others. */
#ifndef T3R_STAGES_H
#define T3R_STAGES_H

#include "budget/budget.h"
#include "state/state.h"
#include "state/views.h"
#include "trim3r.h"

/* The views first..end - 1: all views of a build, one view of a keyframe. */
typedef struct t3r_view_span {
    uint32_t first, end;
} t3r_view_span;

/* Parts of stage pointmap after alignment: each has one step of progress per view. */
typedef enum t3r_pointmap_part {
    T3R_PART_LEND,
    T3R_PART_BRIDGE,
    T3R_PART_SETTLE,
    T3R_PART_FLYING_PIXELS,
    T3R_PART_EXPOSURE,
    T3R_PART_REDUNDANCY,
    T3R_PART_COUNT
} t3r_pointmap_part;

/* Reports step `done` of a part; false cancels. */
bool t3r_pointmap_step(const t3r_runtime *rt, t3r_view_span span, t3r_pointmap_part part, uint32_t done);
/* Returns the steps of the stage, including alignment's. */
uint32_t t3r_pointmap_steps(const t3r_runtime *rt, t3r_view_span span);

/* Fills small holes in a sensor's depth, or finds depth by stereo in the views of a build. */
t3r_status t3r_find_depth(t3r_runtime *rt, t3r_view *views, t3r_view_span span);

/* Chooses the frame of the scene from all views, unless a build follows another, and computes the poses in it. */
t3r_status t3r_choose_frame(t3r_runtime *rt, t3r_view *views);

/* Bridges wide holes. */
t3r_status t3r_bridge_holes(t3r_runtime *rt, t3r_view *views, t3r_view_span span);

/* Marks pixels that other views contradict. */
t3r_status t3r_find_flying_pixels(t3r_runtime *rt, t3r_view *views, t3r_view_span span);

/* Measures texture; blurring follows later. */
t3r_status t3r_find_texture(t3r_runtime *rt, t3r_view *views, t3r_view_span span);

/* Returns the settings that choose points, of the last build or of a stream's next keyframe (except the number of
 * Gaussians, which the map decides). `views` come from t3r_views_of(). */
t3r_budget_settings t3r_budget_settings_of(const t3r_runtime *rt, const t3r_view *views);

t3r_budget_work t3r_budget_work_of(const t3r_runtime *rt);

/* Chooses the points that become Gaussians. */
void t3r_choose_points(const t3r_runtime *rt, const t3r_view *views, t3r_view_span span,
                       const t3r_budget_settings *settings);

#endif
