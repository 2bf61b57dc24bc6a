/* Matching cost: how many of 24 comparisons differ between two neighbourhoods (SPEC.md, "Stereo").
 *
 * The census of a pixel compares 24 pairs of places in the 7 x 5 pixels about it. Only order counts, so any exposure,
 * gain or gamma gives the same bits. They are held as three planes of bytes, so that a vector counts the differences of
 * 16 disparities at a time. */
#ifndef T3R_KERNEL_CENSUS_H
#define T3R_KERNEL_CENSUS_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r_arena.h"

#define T3R_CENSUS_ROWS 5
#define T3R_CENSUS_REACH 3 /* columns to either side */
#define T3R_CENSUS_PAIRS 24
/* Cost against a pixel without luma: half of the bits, what two unlike places have. */
#define T3R_CENSUS_NOTHING 12

/* rows: the luma rows y - 2..y + 2, each `width` (2..) long; beyond the ends of a row its end counts. Writes bits[byte
 * of the census x pitch + x] for x below the width. Nothing is aligned. */
typedef void t3r_census_row_kernel(const uint8_t *const rows[T3R_CENSUS_ROWS], uint32_t width, uint32_t pitch,
                                   uint8_t *bits);

/* The costs, 0..24, of one pixel against `count` (a multiple of 16) others: bits and others as census_row wrote them,
 * the first of the others at the pointer; at least `least[k]`, 0..24, for other k. Nothing is aligned, and nothing
 * beyond `count` is read or written. */
typedef void t3r_census_cost_kernel(const uint8_t own[T3R_CENSUS_BYTES], const uint8_t *others, uint32_t pitch,
                                    const uint8_t *least, uint32_t count, uint8_t *restrict cost);

t3r_census_row_kernel t3r_census_row_c;
t3r_census_cost_kernel t3r_census_cost_c;

#endif
