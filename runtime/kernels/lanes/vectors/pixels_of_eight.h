/* SPDX-License-Identifier: Apache-2.0 */
/* Eight pixels of a tile's row in a vector, for blending and scattering. Included after a header of four lanes. */
#ifndef T3R_KERNELS_LANES_PIXELS_OF_EIGHT_H
#define T3R_KERNELS_LANES_PIXELS_OF_EIGHT_H

#include "kernels/blend.h"
#include "tile_planes.h"

#define PIXELS 8
#define PIXELS_USUAL T3R_ONE_ROW

/* Shapes of a vector's pixels (pixels_avx2.h); here always one row. */
typedef enum shape { T3R_ONE_ROW, T3R_TWO_ROWS, T3R_WHOLE_ROW } shape;

static inline T3R_LANES_TARGET lanes load_pixels(const void *from, shape which)
{
    (void)which;
    return load(from);
}

static inline T3R_LANES_TARGET void store_pixels(uint16_t *at, shape which, lanes x)
{
    (void)which;
    store(at, x);
}

/* Loads the kept weights and alphas of the pixels. */
static inline T3R_LANES_TARGET void load_kept(const t3r_blended_row *row, const t3r_blended_row *high, shape which,
                                              lanes *weights, lanes *alphas)
{
    (void)high;
    (void)which;
    *weights = load(row->weight_q16);
    *alphas = load(row->alpha_q15);
}

static inline T3R_LANES_TARGET void store_kept(t3r_blended_row *row, t3r_blended_row *high, shape which, lanes weights,
                                               lanes alphas)
{
    (void)high;
    (void)which;
    store(row->weight_q16, weights);
    store(row->alpha_q15, alphas);
}

#endif
