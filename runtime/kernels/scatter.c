#include "scatter.h"

#include <string.h>

#include "core/fixed.h"
#include "scatter_columns.h"

/* Weights of both groups, those of row j at 16 group + j. */
typedef struct masked_weights {
    t3r_blend_weights rows[T3R_TILE_GROUPS * T3R_TILE_SIDE];
} masked_weights;

/* The weights of pixels that count, in the splat's box; returns all of their bits. Beyond the box alpha is 0 but for
 * roundings, and refinement counts the box. */
static uint32_t mask(const t3r_wanted *want, const t3r_tile_splat *splat, const t3r_blend_weights *weights,
                     masked_weights *masked)
{
    const uint32_t rows = splat->last - splat->first + 1u;
    uint32_t bits = 0;
    for (uint32_t group = 0; group < splat->groups; group++) {
        const uint32_t column = splat->column + group * T3R_LANES;
        uint16_t inside[T3R_LANES];
        for (uint32_t k = 0; k < T3R_LANES; k++) {
            inside[k] = column + k >= splat->x0 && column + k <= splat->x1 ? UINT16_MAX : 0;
        }
        bits |= t3r_mask_weights(want, inside, column, splat->first, splat->last, weights + group * rows,
                                 masked->rows + group * T3R_TILE_SIDE);
    }
    return bits;
}

static bool is_empty(const masked_weights *masked, uint32_t groups, uint32_t row)
{
    uint64_t bits = 0;
    for (uint32_t group = 0; group < groups; group++) {
        uint64_t halves[2];
        memcpy(halves, masked->rows[group * T3R_TILE_SIDE + row].q16, sizeof halves);
        bits |= halves[0] | halves[1];
    }
    return bits == 0;
}

bool t3r_scatter_c(const t3r_wanted *want, const t3r_tile *tile, const t3r_tile_splat *splat,
                   const t3r_blend_weights *weights, t3r_tile_sums *sums)
{
    masked_weights masked;
    uint32_t bits = mask(want, splat, weights, &masked);
    if (bits == 0) {
        return false;
    }
    uint32_t first = splat->first, last = splat->last; /* a row between them is not empty */
    while (is_empty(&masked, splat->groups, first)) {
        first++;
    }
    while (is_empty(&masked, splat->groups, last)) {
        last--;
    }
    memset(sums, 0, sizeof *sums);
    sums->scale = 15 - t3r_msb32(bits);
    sums->last = last;
    for (uint32_t group = 0; group < splat->groups; group++) {
        t3r_scatter_sums columns;
        t3r_scatter_columns(want, tile, splat->colour_q7, splat->column + group * T3R_LANES, first, last,
                            masked.rows + group * T3R_TILE_SIDE, sums->scale, &columns);
        t3r_tile_sums_add(sums, &columns);
    }
    return true;
}
