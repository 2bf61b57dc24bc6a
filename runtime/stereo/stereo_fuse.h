/* SPDX-License-Identifier: Apache-2.0 */
/* Fusion of the depths of a view from several pairs (SPEC.md, "Stereo: more than two views"). */
#ifndef T3R_STEREO_FUSE_H
#define T3R_STEREO_FUSE_H

#include "state/views.h"

/* Adds one more pair's result `found` to a view's depth. Both have match confidences T3R_STEREO_..., and depths in
 * steps of their own depth_unit_q40; the view keeps its unit. Takes the mean of depths that agree, else the surer
 * one. */
void t3r_stereo_fuse(const t3r_view *view, const t3r_view *found);

#endif
