/* Several pairs' depths of one view brought together (SPEC.md, "Stereo: more than two views"). */
#ifndef T3R_STEREO_FUSE_H
#define T3R_STEREO_FUSE_H

#include "state/views.h"

/* Adds what one more pair found of a view to what there is: both have match confidences T3R_STEREO_..., and depths in
 * steps of their own depth_unit_q40; the view keeps its unit. Of two that agree the mean, of two that do not the surer.
 */
void t3r_stereo_fuse(const t3r_view *view, const t3r_view *found);

#endif
