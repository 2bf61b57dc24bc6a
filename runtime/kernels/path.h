/* Semi-global aggregation: one row of pixels along several paths (SPEC.md, "Stereo").
 *
 *     L(p, k) = C(p, k) + min(L'(k), L'(k - 1) + P1, L'(k + 1) + P1, P2),    L' = L(before p on the path) - its least
 *
 * C is at most 24, so L at most 24 + P2 and the least of L at most 24: with P1 + P2 + 24 < 256 nothing leaves 8 bits.
 *
 * A path's state is a row of slots, one a pixel, with one more at either end where paths begin: a slot is a guard byte
 * and `disparities` values; behind the last one stands another guard. The leasts are kept in a row of their own. */
#ifndef T3R_KERNEL_PATH_H
#define T3R_KERNEL_PATH_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "census.h"

#define T3R_PATH_LANES 16u
#define T3R_PATH_MOST 256u /* disparities */
#define T3R_PATH_PENALTIES 256

typedef struct t3r_path_costs {
    uint8_t same;                     /* P1: for a step of one disparity */
    uint8_t guard;                    /* P2 at its largest + 24: never chosen, and with P1 below 256 */
    uint8_t step[T3R_PATH_PENALTIES]; /* P2 by how much luma changes on the way */
} t3r_path_costs;

/* Penalties `same` (P1) and `step` (P2 where luma does not change); P1 + P2 below 232. */
t3r_path_costs t3r_path_costs_of(uint32_t same, uint32_t step, uint32_t least_step);

/* An empty state: every path begins here. */
void t3r_path_begin(uint8_t *state, uint32_t width, uint32_t disparities, uint8_t guard);

/* One row. states: `diagonals` ? 3 : 1 path states that lie one behind the other, T3R_PATH_STATE_BYTES each: straight,
 * from the left, from the right in the row before. */
typedef struct t3r_path_row {
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
