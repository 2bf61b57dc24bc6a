/* SPDX-License-Identifier: Apache-2.0 */
/* Stage depth by stereo: chooses pairs of views, matches them, and fuses each view's depths (SPEC.md, "Stereo: more
 * than two views"). */
#ifndef T3R_STEREO_VIEWS_H
#define T3R_STEREO_VIEWS_H

#include <stdbool.h>

#include "state/views.h"
#include "trim3r.h"

/* Partners of each view, by the highest match score. */
#define T3R_STEREO_PARTNERS 2u

/* Clears the planes of depth and validity, which without a sensor hold the results of an earlier analysis. */
void t3r_stereo_clear(const t3r_view *views, uint32_t count);

/* Computes depth planes, depth units and validity (as t3r_stereo_marks() does) of all views of the runtime, and records
 * which pair each came from. Returns T3R_ERR_STEREO when no pair can be matched, or T3R_ERR_CANCELLED. */
t3r_status t3r_stereo_views(t3r_runtime *rt, t3r_view *views);

/* Copies the results of t3r_stereo_views() from rt->depth_of, which has found points and done nothing since. Returns
 * false, without copying, unless that runtime would compute the same bits: its views and settings of stereo agree. */
bool t3r_stereo_take(t3r_runtime *rt, t3r_view *views);

/* Fills view v, which was matched with view `other`, if the configuration says so, and sets its validity. work: that
 * of a pair. */
void t3r_stereo_finish(const t3r_runtime *rt, const t3r_view *views, uint32_t v, uint32_t other, void *work);

#endif
