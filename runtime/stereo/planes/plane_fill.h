/* SPDX-License-Identifier: Apache-2.0 */
/* Fills pixels that stereo could not match, by labels of planes and surroundings (SPEC.md, "Stereo: planes"). */
#ifndef T3R_PLANE_FILL_H
#define T3R_PLANE_FILL_H

#include <stddef.h>

#include "depth/surroundings.h"
#include "plane_labels.h"
#include "plane_search.h"
#include "plane_sweep.h"

/* Bytes of work, aligned to 64: the search, the filling, and the labels beside its lengths of paths. */
#define T3R_PLANE_FILL_BYTES(width, height)                                                                            \
    T3R_MAX_(T3R_MAX_(T3R_PLANE_SEARCH_BYTES, T3R_SURROUNDINGS_BYTES_(width, height)),                                 \
             T3R_SURROUNDINGS_LENGTHS_(width, height) + T3R_PLANE_LABELS_BYTES + T3R_PLANE_SWEEP_BYTES(width, height))

/* A view with matches, and the one that it was matched with; both of one size. */
typedef struct t3r_plane_pair {
    const t3r_kernels *kernels;
    const t3r_view *view, *other;
    const t3r_camera *camera, *other_camera; /* checked and undistorted */
} t3r_plane_pair;

/* Fills pixels that show something and have no depth, with match confidence T3R_STEREO_FILLED, as
 * t3r_fill_surroundings() does; then gives them a mix of that depth, of the planes on which the view's matched pixels
 * lie, and of a far one. Reads only colours of the other view. */
void t3r_plane_fill(const t3r_plane_pair *pair, void *work);

#endif
