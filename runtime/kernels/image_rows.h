/* SPDX-License-Identifier: Apache-2.0 */
/* Conversion of camera rows to planes, and the sums for resizing (SPEC.md, "Image"). No pointer is aligned, and nothing
 * is read or written beyond the counts. */
#ifndef T3R_KERNEL_IMAGE_ROWS_H
#define T3R_KERNEL_IMAGE_ROWS_H

#include <stddef.h>
#include <stdint.h>

/* Converts `count` pixels, an even number, of YUV 4:2:2, limited range, to R, G, B. Four bytes hold two pixels: their
 * lumas at y_at and y_at + 2, their chroma at u_at and u_at + 2; (0, 1) is YUYV, (1, 0) UYVY. */
typedef void t3r_packed_row_kernel(const uint8_t *restrict in, uint32_t count, uint32_t y_at, uint32_t u_at,
                                   uint8_t *restrict r, uint8_t *restrict g, uint8_t *restrict b);

/* Converts NV12: `count` lumas and count / 2 pairs of chroma. */
typedef void t3r_nv12_row_kernel(const uint8_t *restrict luma, const uint8_t *restrict chroma, uint32_t count,
                                 uint8_t *restrict r, uint8_t *restrict g, uint8_t *restrict b);

/* Splits `count` triples into three rows. */
typedef void t3r_triple_row_kernel(const uint8_t *restrict in, uint32_t count, uint8_t *restrict first,
                                   uint8_t *restrict second, uint8_t *restrict third);

/* Position of a walk over the boxes of a destination row: in `box`, with `left` units still open. */
typedef struct t3r_box_walk {
    uint32_t box, left;
} t3r_box_walk;

/* Adds `count` samples of one channel to the sums of the boxes they lie in, each sample times its units in the box. A
 * sample is sample_units long, a box box_units: both 1..T3R_MAX_SIDE. A box's sum is below 2^20. Returns the new
 * position of the walk. */
typedef t3r_box_walk t3r_box_sums_kernel(t3r_box_walk at, const uint8_t *restrict run, uint32_t count,
                                         uint32_t sample_units, uint32_t box_units, uint32_t *restrict sums);

/* Computes total[i] += weight x sums[i]; below 2^32. */
typedef void t3r_weigh_row_kernel(uint32_t *restrict total, const uint32_t *restrict sums, uint32_t weight,
                                  uint32_t count);

/* Computes out[i] = total[i] / area, round-half-up, and total[i] = 0. total <= 255 area, area 1..2^24. */
typedef void t3r_divide_row_kernel(uint32_t *restrict total, uint32_t area, uint32_t count, uint8_t *restrict out);

t3r_packed_row_kernel t3r_packed_row_c;
t3r_nv12_row_kernel t3r_nv12_row_c;
t3r_triple_row_kernel t3r_triple_row_c;
t3r_box_sums_kernel t3r_box_sums_c;
t3r_weigh_row_kernel t3r_weigh_row_c;
t3r_divide_row_kernel t3r_divide_row_c;

#endif
