/* Stage depth by stereo: pairs chosen among the views, matched, and each view's depths brought together (SPEC.md,
 * "Stereo: more than two views"). */
#ifndef T3R_STEREO_VIEWS_H
#define T3R_STEREO_VIEWS_H

#include "trim3r.h"
#include "state/views.h"

/* Each view is matched with so many others, those of the highest match score. */
#define T3R_STEREO_PARTNERS 2u

/* Clears the planes of depth and validity: without a sensor they hold what an earlier analysis made. */
void t3r_stereo_clear(const t3r_view *views, uint32_t count);

/* Depth planes, depth units and validity (as t3r_stereo_marks() has it) of all views of the runtime, and what each
 * came from. T3R_ERR_STEREO when no pair can be matched, T3R_ERR_CANCELLED. */
t3r_status t3r_stereo_views(t3r_runtime *rt, t3r_view *views);

#endif
