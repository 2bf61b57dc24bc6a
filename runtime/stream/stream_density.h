/* SPDX-License-Identifier: Apache-2.0 */
/* The density of a stream's map on the surface that a keyframe sees, in Gaussians a pixel (SPEC.md, "Streams"). It is
 * conserved: each Gaussian counts as one, spread over its surface. It decides which points join and how wide Gaussians
 * are, so that a place seen again and again stays as it is. */
#ifndef T3R_STREAM_DENSITY_H
#define T3R_STREAM_DENSITY_H

#include <stdint.h>

#include "budget/budget.h"
#include "core/workers.h"
#include "kernels/kernels.h"
#include "stream_discs.h"
#include "stream_map.h"

typedef struct t3r_map_density {
    const t3r_map *map;
    const t3r_pointmap *keyframe;
    const t3r_workers *workers;
    t3r_map_disc *discs; /* of each Gaussian of the map, until the map drops any */
    uint32_t *plane_q16; /* Gaussians a pixel; one entry for each of the keyframe's pixels, at most 2^30 */
} t3r_map_density;

/* Finds the discs and the plane: spreads each Gaussian evenly over the pixels around it that show its surface, be it
 * visible there or hidden. */
void t3r_map_density_find(const t3r_map_density *density);

/* Fits the widths of the Gaussians that the keyframe saw to the density measured around them. They widen or narrow with
 * the spacing. */
void t3r_map_density_fit(const t3r_map_density *density);

/* Raises the keys of the keyframe's points, to T3R_MAP_KEY_LEAST at least: the map's Gaussians have the thresholds up
 * to four times their density. The plane becomes the least keys, 0 where there is no density. Marks points as covered
 * where no threshold is left. */
void t3r_map_density_raise_keys(const t3r_map_density *density, const t3r_budget_settings *settings,
                                const t3r_kernels *kernels);

/* Marks the points whose least key is above the threshold as covered. Returns the number of covered points. */
uint32_t t3r_map_density_mark(const t3r_map_density *density, uint32_t threshold);

#endif
