/* Penalties and empty states of semi-global aggregation (kernels/path_row.h; SPEC.md, "Stereo"). */
#ifndef T3R_PATH_H
#define T3R_PATH_H

#include "kernels/path_row.h"

/* Returns the table of penalties: P1, P2 where luma doesn't change, and the least P2. P1 + P2 below 232. */
t3r_path_costs t3r_path_costs_of(uint32_t p1, uint32_t p2, uint32_t p2_min);

/* Clears a state: every path begins with an empty one. */
void t3r_path_begin(uint8_t *state, uint32_t width, uint32_t disparities, uint8_t guard);

#endif
