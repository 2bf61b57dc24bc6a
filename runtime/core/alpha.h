/* SPDX-License-Identifier: Apache-2.0 */
/* The polynomial of a pixel's alpha: exp(s - 0.75) on [0, 0.75] in Q16, C0 + s (C1 + s (C2 + s (C3 + s C4))). It is
 * minimax with rounding down included. Squared three times it is exp(-q) with s = 0.75 - q / 8, below 1 and off by at
 * most 18 / 65,536. */
#ifndef T3R_KERNEL_ALPHA_H
#define T3R_KERNEL_ALPHA_H

#define T3R_ALPHA_C0 30957
#define T3R_ALPHA_C1 30946
#define T3R_ALPHA_C2 15598
#define T3R_ALPHA_C3 4735
#define T3R_ALPHA_C4 1892
#define T3R_ALPHA_RANGE 49152 /* 0.75: exp(-6) x 1 is already below 1/255 */

#endif
