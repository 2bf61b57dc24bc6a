/* The two directions of the texture's blur: a 5 x 5 box twice is nine taps 1 2 3 4 5 4 3 2 1 along each axis, over 25,
 * halves up. A row is 1..T3R_MAX_SIDE samples, none of it aligned; nothing beyond it is read or written. */
#ifndef T3R_KERNEL_BLUR_H
#define T3R_KERNEL_BLUR_H

#include <stdint.h>

#define T3R_BLUR_REACH 4
#define T3R_BLUR_TAPS (2 * T3R_BLUR_REACH + 1)

/* Along a row; beyond its ends its end samples count. */
typedef void t3r_blur_row_kernel(const uint16_t *restrict row, uint32_t width, uint16_t *restrict out);

/* Down the columns of nine rows, which may be the same where they lie beyond the plane. */
typedef void t3r_blur_column_kernel(const uint16_t *const rows[T3R_BLUR_TAPS], uint32_t width, uint16_t *restrict out);

t3r_blur_row_kernel t3r_blur_row_c;
t3r_blur_column_kernel t3r_blur_column_c;

#endif
