#include "scatter.h"

#include "core/fixed.h"
#include "core/memory.h"
#include "scatter_columns.h"

/* The weights of a group's pixels that count, in the splat's box, row j at masked[j]; returns all of their bits. Beyond
 * the box alpha is 0 but for roundings, and refinement counts the box. */
static uint16_t mask(const t3r_wanted *want, const t3r_tile_splat *splat, uint32_t group,
                     const t3r_blend_weights *weights, t3r_blend_weights masked[T3R_TILE_SIDE])
{
    const uint32_t rows = splat->last - splat->first + 1u, column = splat->column + group * T3R_LANES;
    uint16_t inside[T3R_LANES];
    for (uint32_t k = 0; k < T3R_LANES; k++) {
        inside[k] = column + k >= splat->x0 && column + k <= splat->x1 ? UINT16_MAX : 0;
    }
    return t3r_mask_weights(want, inside, column, splat->first, splat->last, weights + group * rows, masked);
}

/* Bit j: row j is not empty. */
static uint32_t filled_rows(const t3r_tile_splat *splat, const t3r_blend_weights masked[T3R_TILE_SIDE])
{
    uint32_t filled = 0;
    for (uint32_t j = splat->first; j <= splat->last; j++) {
        uint64_t halves[2];
        memcpy(halves, masked[j].q16, sizeof halves);
        filled |= (uint32_t)((halves[0] | halves[1]) != 0) << j;
    }
    return filled;
}

bool t3r_scatter_c(const t3r_wanted *want, const t3r_tile *tile, const t3r_tile_splat *splat,
                   const t3r_blend_weights *weights, t3r_tile_sums *sums)
{
    t3r_blend_weights masked[T3R_TILE_SIDE]; /* of one group: two are masked twice, as stack is dear */
    uint32_t bits = 0, filled = 0;
    for (uint32_t group = 0; group < splat->groups; group++) {
        bits |= mask(want, splat, group, weights, masked);
        filled |= filled_rows(splat, masked);
    }
    if (bits == 0) {
        return false;
    }
    const uint32_t first = t3r_msb32(filled & (0 - filled)), last = t3r_msb32(filled);
    memset(sums, 0, sizeof *sums);
    sums->scale = 15 - t3r_msb32(bits);
    sums->last = last;
    for (uint32_t group = 0; group < splat->groups; group++) {
        if (splat->groups > 1) {
            (void)mask(want, splat, group, weights, masked);
        }
        t3r_scatter_sums columns;
        t3r_scatter_columns(want, tile, splat->colour_q7, splat->column + group * T3R_LANES, first, last, masked,
                            sums->scale, &columns);
        t3r_tile_sums_add(sums, &columns);
    }
    return true;
}
