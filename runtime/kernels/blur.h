/* The two directions of the texture's blur. A 5 x 5 box applied twice has nine taps 1 2 3 4 5 4 3 2 1 along each axis,
 * over 25, round-half-up. A row is 1..T3R_MAX_SIDE samples, unaligned; nothing beyond it is read or written. */
#ifndef T3R_KERNEL_BLUR_H
#define T3R_KERNEL_BLUR_H

#include <stdint.h>

#define T3R_BLUR_REACH 4
#define T3R_BLUR_TAPS (2 * T3R_BLUR_REACH + 1)

/* Blurs along a row; beyond its ends the end samples repeat. */
typedef void t3r_blur_row_kernel(const uint16_t *restrict row, uint32_t width, uint16_t *restrict out);

/* Blurs down the columns of nine rows, which may repeat beyond the plane. */
typedef void t3r_blur_column_kernel(const uint16_t *const rows[T3R_BLUR_TAPS], uint32_t width, uint16_t *restrict out);

t3r_blur_row_kernel t3r_blur_row_c;
t3r_blur_column_kernel t3r_blur_column_c;

#endif
