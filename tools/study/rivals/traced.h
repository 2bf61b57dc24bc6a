/* SPDX-License-Identifier: Apache-2.0 */
/* Traces Gaussians back to their pixels, with the runtime's own masks. */
#ifndef TRIM3R_TOOLS_RIVALS_TRACED_H
#define TRIM3R_TOOLS_RIVALS_TRACED_H

#include <stdint.h>

#include "reconstruction/reconstruction.h"

/* Importances for the allocation `given`: one plane per context view at the working size. */
typedef struct traced_points {
    uint16_t *planes[T3R_MAX_VIEWS];
} traced_points;

/* Sets importance 65535 at the points that a build by `options` retains at its budget, 0 elsewhere. With `kept`, only
 * at its points: `count` ascending indices into the scene of that build, whose Gaussians are ordered by view, row and
 * column for every head, refined or not. Returns an exit status of cli.h, after a message; call traced_points_free()
 * in either case. */
int traced_points_make(traced_points *points, const t3r_recording *recording, const char *path,
                       const reconstruction_options *options, const uint32_t *kept, uint32_t count);
void traced_points_free(traced_points *points);

#endif
