/* The polynomial of a pixel's alpha: exp(s - 0.75) on [0, 0.75] in Q16, C0 + s (C1 + s (C2 + s (C3 + s C4))), minimax,
 * C0 and C1 lowered so that the result stays below 1: error below 2^-15, with the roundings below 2^-14. Squared three
 * times it is exp(-q) with s = 0.75 - q / 8. */
#ifndef T3R_KERNEL_ALPHA_H
#define T3R_KERNEL_ALPHA_H

#define T3R_ALPHA_C0 30957
#define T3R_ALPHA_C1 30944
#define T3R_ALPHA_C2 15597
#define T3R_ALPHA_C3 4735
#define T3R_ALPHA_C4 1892
#define T3R_ALPHA_RANGE 49152 /* 0.75: exp(-6) x 1 is below 1/255 already */

#endif
