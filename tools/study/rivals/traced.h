/* SPDX-License-Identifier: Apache-2.0 */
/* Gaussians traced back to the pixels that they came from, as the runtime's own masks tell. */
#ifndef TRIM3R_TOOLS_RIVALS_TRACED_H
#define TRIM3R_TOOLS_RIVALS_TRACED_H

#include <stdint.h>

#include "reconstruction/reconstruction.h"

/* Importances of the allocation `given`, a plane a context view at the working size. */
typedef struct traced_points {
    uint16_t *planes[T3R_MAX_VIEWS];
} traced_points;

/* The points that a build by `options` retains at its budget are important (65535), all others not (0). Of these points
 * stay, where `kept` is not NULL, those of the `count` indices in rising order that it holds: indices into the scene of
 * that build, whose Gaussians stand in the order of views, rows and columns, whatever head made them and whatever
 * refined them. An exit status of cli.h after a message; traced_points_free() is due either way. */
int traced_points_make(traced_points *points, const t3r_recording *recording, const char *path,
                       const reconstruction_options *options, const uint32_t *kept, uint32_t count);
void traced_points_free(traced_points *points);

#endif
