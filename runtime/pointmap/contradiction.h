/* SPDX-License-Identifier: Apache-2.0 */
/* Points of one view that another view contradicts by seeing through them. */
#ifndef T3R_CONTRADICTION_H
#define T3R_CONTRADICTION_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "reproject.h"
#include "state/views.h"

typedef struct t3r_contradictions {
    t3r_pointmap maps[T3R_MAX_VIEWS];
    uint32_t count, v; /* number of views, and the view whose points are tested */
    bool guessed; /* filled depths are guesses; other views' filled depths count, too, but only against filled ones */
    const t3r_kernels *kernels;
    uint8_t *is_flying; /* one per pixel */
} t3r_contradictions;

/* Sets is_flying for the points that another view sees through, and empties the batch. */
void t3r_find_contradicted(const t3r_contradictions *job, t3r_points *points, const t3r_unprojection *from);

/* Whether `to` measured the pixel on which the point falls, and everything that it measured in the 3 x 3 around it is
 * deeper by more than 1/16. With `filled`, every depth counts as measured. */
bool t3r_seen_through(const t3r_pointmap *to, const t3r_projected_pixel *projected, bool filled);

#endif
