/* Semi-global aggregation: one row of pixels along several paths (kernels/path_step.h; SPEC.md, "Stereo").
 *
 * A path's state is a row of slots, one a pixel, with one more at either end where paths begin: a slot is a guard byte
 * and `disparities` values; behind the last one stands another guard. The leasts are kept in a row of their own. */
#ifndef T3R_PATH_H
#define T3R_PATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "kernels/kernels.h"

#define T3R_PATH_PENALTIES 256

typedef struct t3r_path_costs {
    uint8_t p1;                     /* for a step of one disparity */
    uint8_t guard;                  /* P2 at its largest + 24: never chosen, and with P1 below 256 */
    uint8_t p2[T3R_PATH_PENALTIES]; /* for a larger step, by how much luma changes on the way */
} t3r_path_costs;

/* Penalties P1, P2 where luma does not change, and the least of P2; P1 + P2 below 232. */
t3r_path_costs t3r_path_costs_of(uint32_t p1, uint32_t p2, uint32_t p2_min);

/* An empty state: every path begins here. */
void t3r_path_begin(uint8_t *state, uint32_t width, uint32_t disparities, uint8_t guard);

/* One row. states: `diagonals` ? 3 : 1 path states that lie one behind the other, T3R_PATH_STATE_BYTES each: straight,
 * from the left, from the right in the row before. */
typedef struct t3r_path_row {
    const t3r_kernels *kernels;
    uint32_t width, disparities; /* disparities: a multiple of 16 */
    const t3r_path_costs *costs;
    const uint8_t *luma, *luma_before; /* rows of the picture; before = the one that `from` belongs to */
    const uint8_t *cost;               /* width x disparities */
    const uint8_t *from;
    uint8_t *to; /* all of it is written but guards and ends */
} t3r_path_row;

/* The paths that come from another row alone. */
void t3r_path_rows(const t3r_path_row *row, bool diagonals);

/* These and the one along the row, from the left (reverse: from the right); sums: width x disparities, set to the sum
 * of all paths (reverse: added). */
void t3r_path_sums(const t3r_path_row *row, bool diagonals, bool reverse, int16_t *sums);

#endif
