/* What plain C makes of a splat in a tile, eight columns at a time: sums down each column (SPEC.md, "Refinement"). */
#ifndef T3R_KERNEL_SCATTER_COLUMNS_H
#define T3R_KERNEL_SCATTER_COLUMNS_H

#include <stdint.h>

#include "scatter.h"

/* Sums down each column over the rows first..last, row j with the weight C(last - j + l, l): l = 0 the plain sum, l = 1
 * the sum of the sums so far, and so on. Of at most 16 rows these weights sum to 16, 136, 816, 3,876 and 15,504.
 * Everything in the scale of w: a factor 2^s, curvature 2^2s. */
typedef struct t3r_scatter_sums {
    uint64_t curvature_4[T3R_LANES];  /* |g|^2, levels^2, Q2: l = 4 */
    uint32_t curvature[4][T3R_LANES]; /* l = 0..3; at most 786,432 a pixel */
    int32_t gradient[3][T3R_LANES];   /* g . r, levels^2, Q3: l = 0..2; at most 1,566,720 a pixel */
    int32_t colour[3][T3R_LANES];     /* w r, levels, Q19; the plain sum alone */
    int32_t weight[T3R_LANES];        /* w, Q15; likewise */
} t3r_scatter_sums;

/* masked[first..last] are these weights, but 0 in columns that are not `inside` (65,535, else 0) and where a pixel does
 * not count; returns all of their bits. */
uint16_t t3r_mask_weights(const t3r_wanted *want, const uint16_t inside[T3R_LANES], uint32_t column, uint32_t first,
                          uint32_t last, const t3r_blend_weights *weights, t3r_blend_weights *restrict masked);

/* The sums of weights[first..last], below 2^(16 - scale), of a splat of that colour. `tile` is as it is after the
 * splat. The weights are scaled in place. */
void t3r_scatter_columns(const t3r_wanted *want, const t3r_tile *tile, const uint16_t colour_q7[3], uint32_t column,
                         uint32_t first, uint32_t last, t3r_blend_weights *weights, uint32_t scale,
                         t3r_scatter_sums *sums);

/* Adds eight columns that follow those already summed: at most two times. */
void t3r_tile_sums_add(t3r_tile_sums *sums, const t3r_scatter_sums *columns);

/* About 2^31 / n for n = 2^15..2^16 - 1: too small by at most 2^-13 of it, never so large that n times it reaches 2^31.
 * Exposed for tests. */
uint16_t t3r_reciprocal_q31(uint16_t n);

#endif
