/* Points of one view that another contradicts: it sees through them. */
#ifndef T3R_CONTRADICTION_H
#define T3R_CONTRADICTION_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "reproject.h"
#include "state/views.h"

typedef struct t3r_contradictions {
    t3r_pointmap maps[T3R_MAX_VIEWS];
    uint32_t count, v; /* views, and the one whose points are looked at */
    bool guessed;      /* filled depths are guesses, and those of other views bear witness too, against filled ones */
    const t3r_kernels *kernels;
    uint8_t *is_flying; /* of each pixel */
} t3r_contradictions;

/* Notes the points through which another view sees in is_flying; then there are none. */
void t3r_find_contradicted(const t3r_contradictions *job, t3r_points *points, const t3r_unprojection *from);

/* Whether `to` measured the pixel that the point falls on, and everything measured about it is deeper by more than
 * 1/16; with `filled`, every depth counts as measured. */
bool t3r_seen_through(const t3r_pointmap *to, const t3r_projected_pixel *projected, bool filled);

#endif
