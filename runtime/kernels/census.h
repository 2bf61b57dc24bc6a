/* SPDX-License-Identifier: Apache-2.0 */
/* Matching cost: the number of 24 comparisons that differ between two neighbourhoods (SPEC.md, "Stereo").
 *
 * The census of a pixel compares 24 pairs of places in the 7 x 5 pixels around it. Only order counts, so any exposure,
 * gain or gamma gives the same bits. They are stored as three planes of bytes, so that a vector counts the differences
 * of 16 disparities at a time. */
#ifndef T3R_KERNEL_CENSUS_H
#define T3R_KERNEL_CENSUS_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r_arena.h"

#define T3R_CENSUS_ROWS 5
#define T3R_CENSUS_REACH 3 /* columns to either side */
#define T3R_CENSUS_PAIRS 24
/* Cost against a pixel without luma: half of the bits, like two unrelated places. */
#define T3R_CENSUS_NOTHING 12

/* Computes the census of a row. rows: the luma rows y - 2..y + 2, each `width` (2..) long; the ends of a row repeat.
 * Writes bits[byte of the census x pitch + x] for x below the width. Nothing is aligned. */
typedef void t3r_census_row_kernel(const uint8_t *const rows[T3R_CENSUS_ROWS], uint32_t width, uint32_t pitch,
                                   uint8_t *bits);

/* Costs of a row's pixels against all their candidates: disparity k of pixel x is right column x + disparities - 1 -
 * k. */
typedef struct t3r_census_costs {
    uint32_t width, disparities; /* width of the left row; disparities: a multiple of 16 up to T3R_PATH_MOST */
    const uint8_t *luma;         /* of both rows, 0 = no luma; a left pixel without luma costs 0 throughout */
    const uint8_t *luma_right;
    const uint8_t *bits;       /* from census_row, with a pitch of the row's length, `width` */
    const uint8_t *bits_right; /* likewise, with a pitch of T3R_MATCH_RIGHT(width, disparities) */
    uint8_t *mirrored;         /* work: the right row's bits by falling column, three times its length */
    uint8_t *least;            /* work: the least cost against each right pixel, by falling column */
    uint8_t *cost;             /* width x disparities: 0..24 */
} t3r_census_costs;

/* Fills `mirrored` and `least`. */
static inline void t3r_census_mirror(const t3r_census_costs *row)
{
    const size_t right = T3R_MATCH_RIGHT(row->width, row->disparities);
    for (size_t i = 0; i < T3R_CENSUS_BYTES; i++) {
        const uint8_t *from = row->bits_right + i * right;
        uint8_t *to = row->mirrored + i * right;
        for (size_t n = 0; n < right; n++) {
            to[n] = from[right - 1 - n];
        }
    }
    for (size_t n = 0; n < right; n++) {
        row->least[n] = row->luma_right[right - 1 - n] == 0 ? T3R_CENSUS_NOTHING : 0;
    }
}

/* Computes the costs. Nothing is aligned. */
typedef void t3r_census_costs_kernel(const t3r_census_costs *row);

t3r_census_row_kernel t3r_census_row_c;
t3r_census_costs_kernel t3r_census_costs_c;

#endif
