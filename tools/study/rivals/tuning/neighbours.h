/* SPDX-License-Identifier: Apache-2.0 */
/* Widths of Gaussians from the distances to their neighbours, as 3D Gaussian Splatting initialises them. */
#ifndef TRIM3R_TOOLS_RIVALS_NEIGHBOURS_H
#define TRIM3R_TOOLS_RIVALS_NEIGHBOURS_H

#include <stdbool.h>

#include "study/rivals/splats/splat_model.h"

/* Number of neighbours that count, from the authors' code (simple-knn). */
enum { NEIGHBOURS = 3 };

/* Computes the root of the mean squared distance from each Gaussian's centre to the nearest NEIGHBOURS others, or to
 * all others if they are fewer; 0 if there is none. Returns false if out of memory. distance[model->count]: scene
 * units. */
bool neighbour_distances(const splat_model *model, double *distance);

/* Scales every Gaussian so that its largest standard deviation is this distance; its shape stays. A Gaussian whose
 * neighbours are all in its own place stays as it is. Returns false if out of memory. */
bool neighbour_widen(splat_model *model);

#endif
