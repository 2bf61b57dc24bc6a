/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_fill.h"

#include "core/cut.h"
#include "plane_costs.h"
#include "plane_mix.h"
#include "plane_paths.h"

void t3r_plane_fill(const t3r_plane_pair *pair, void *work)
{
    const t3r_view *view = pair->view;
    t3r_planes planes;
    t3r_search_planes(view, work, &planes);
    const uint16_t *length = t3r_fill_surroundings(view, T3R_FILLED, work);
    if (planes.count == 0) {
        return;
    }
    t3r_cut cut = t3r_cut_of(work, T3R_PLANE_FILL_BYTES(view->width, view->height));
    (void)t3r_take(&cut, T3R_SURROUNDINGS_LENGTHS_(view->width, view->height));
    t3r_plane_labels labels;
    t3r_plane_labels_begin(&labels, view, &planes, &cut);
    t3r_plane_costs(&labels);
    t3r_plane_sweep(&labels, pair->kernels, pair->camera, pair->other, pair->other_camera, &cut);
    t3r_plane_paths(&labels);
    t3r_plane_mix(&labels, length);
}
