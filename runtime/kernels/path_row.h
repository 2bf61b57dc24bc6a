/* SPDX-License-Identifier: Apache-2.0 */
/* Semi-global aggregation of a row of pixels along several paths (SPEC.md, "Stereo").
 *
 *     L(p, k) = C(p, k) + min(L'(k), L'(k - 1) + P1, L'(k + 1) + P1, P2),    L' = L(before p on the path) - its least
 *
 * C is at most 24, so L is at most 24 + P2 and its least at most 24: with P1 + P2 + 24 < 256 everything fits 8 bits.
 *
 * A path's state is a row of slots, one a pixel, with one more at either end where paths begin. A slot is a guard byte
 * and `disparities` values; another guard follows the last slot. The least values are stored in a row of their own. */
#ifndef T3R_KERNEL_PATH_ROW_H
#define T3R_KERNEL_PATH_ROW_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r_arena.h"

#define T3R_PATH_LANES 16u
#define T3R_PATH_MOST 256u /* disparities */
#define T3R_PATH_LINKS 4u  /* maximum paths through a pixel */
#define T3R_PATH_PENALTIES 256

typedef struct t3r_path_costs {
    uint8_t p1;                     /* for a step of one disparity */
    uint8_t guard;                  /* largest P2 + 24: never chosen, and below 256 with P1 added */
    uint8_t p2[T3R_PATH_PENALTIES]; /* for a larger step, by the change of luma */
} t3r_path_costs;

typedef struct t3r_path_row {
    uint32_t width, disparities; /* disparities: a multiple of 16 up to T3R_PATH_MOST */
    bool diagonals;              /* 3 path states instead of 1: straight, from the left, from the right */
    bool reverse;                /* pixels, and the path along the row, go from right to left */
    const t3r_path_costs *costs;
    const uint8_t *luma, *luma_before; /* rows of the picture; luma_before is the row that `from` belongs to */
    const uint8_t *cost;               /* width x disparities */
    const uint8_t *from;               /* path states, T3R_PATH_STATE_BYTES each, consecutive */
    uint8_t *to;                       /* likewise; all is written except guards and ends */
    int16_t *sums; /* width x disparities: set to the sums of all paths, added to with `reverse`; NULL: neither sums nor
                      the path along the row are computed */
} t3r_path_row;

/* Returns the offset of the least values in a path's state; slot s has its own at t3r_path_leasts() + s. */
static inline size_t t3r_path_leasts(uint32_t width, uint32_t disparities)
{
    return ((size_t)width + 2) * ((size_t)disparities + 1) + 1;
}

/* Values of the previous pixel on one path. */
typedef struct t3r_path_link {
    const uint8_t *from; /* a guard byte, the values of all disparities, a guard byte */
    uint8_t least;       /* of these values */
    uint8_t p2;          /* P2 between the two pixels */
} t3r_path_link;

/* Returns the link by which path `path` of the previous row reaches pixel x; the luma of the ends repeats beyond
 * them. */
static inline t3r_path_link t3r_path_link_of(const t3r_path_row *row, uint32_t path, uint32_t x)
{
    const uint8_t *state = row->from + path * T3R_PATH_STATE_BYTES(row->width, row->disparities);
    const uint32_t column = path == 0 ? x : path == 1 ? x - (x > 0) : x + (x + 1 < row->width);
    const uint32_t slot = path == 0 ? x + 1 : path == 1 ? x : x + 2;
    const int32_t change = row->luma[x] - row->luma_before[column];
    return (t3r_path_link){.from = state + slot * ((size_t)row->disparities + 1),
                           .least = state[t3r_path_leasts(row->width, row->disparities) + slot],
                           .p2 = row->costs->p2[change < 0 ? -change : change]};
}

/* Returns P2 along the row to pixel x, the i-th of its path. */
static inline uint8_t t3r_path_p2_along(const t3r_path_row *row, uint32_t x, uint32_t i)
{
    const uint8_t before = row->luma[i == 0 ? x : row->reverse ? x + 1 : x - 1];
    const int32_t change = row->luma[x] - before;
    return row->costs->p2[change < 0 ? -change : change];
}

/* Aggregates one row. Only sums are aligned, to 2 bytes; guards are read and not written; `to` overlaps no input. */
typedef void t3r_path_row_kernel(const t3r_path_row *row);
t3r_path_row_kernel t3r_path_row_c;

#endif
