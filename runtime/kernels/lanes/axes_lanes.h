/* SPDX-License-Identifier: Apache-2.0 */
/* Axes of LANES splats at a time; plain C takes Gaussians that need more than 32 bits. Included after a header of
 * lanes, in a file that names the function AXES. */
#ifndef T3R_KERNELS_LANES_AXES_LANES_H
#define T3R_KERNELS_LANES_AXES_LANES_H

#include "footprint_lanes.h"
#include "kernels/scatter.h"

/* Returns one column of T, times one column of the conic, as in axes.c. */
static inline T3R_LANES_TARGET lanes axis_q15(lanes a_q12, lanes first_q30, lanes b_q12, lanes second_q30)
{
    const wide at_q41 = sum(sum(product(a_q12, first_q30), product(b_q12, second_q30)), all_wide(1 << 25));
    return held(low_of(right(at_q41, 26)), all(T3R_AXIS_MOST_Q15));
}

static inline T3R_LANES_TARGET lanes packed(lanes first, lanes second)
{
    return either(both(first, all(UINT16_MAX)), OF_LANES(slli_epi32)(second, 16));
}

_Static_assert(offsetof(t3r_splat, a_q30) == 8 && offsetof(t3r_splat, c_q30) == 16 && sizeof(t3r_splat) >= 24,
               "a splat's conic is in its words 2 to 4");

/* Computes the axes of LANES splats; returns a bit for each one that plain C has to do. */
static __attribute__((noinline)) T3R_LANES_TARGET uint32_t axes_batch(const t3r_projection *p,
                                                                      const t3r_gaussian *gaussians,
                                                                      const t3r_splat *splats, t3r_refine_sums *sums)
{
    const uint8_t *from[LANES];
    uint8_t *to[LANES];
    lanes words[10], conic[4], a_q12[3], b_q12[3], out[2];
    T3R_LANES_UNROLL for (int i = 0; i < LANES; i++)
    {
        from[i] = (const uint8_t *)&splats[i];
        to[i] = (uint8_t *)&sums[i].axes;
    }
    read_gaussians(gaussians, words);
    read_four(from, 8, conic);
    const by_field g = fields_of(words);
    means m = see(p, &g);
    rows_of(p, &m, &g, a_q12, b_q12);
    out[0] = packed(axis_q15(a_q12[0], conic[0], b_q12[0], conic[1]), axis_q15(a_q12[1], conic[0], b_q12[1], conic[1]));
    out[1] = packed(axis_q15(a_q12[0], conic[1], b_q12[0], conic[2]), axis_q15(a_q12[1], conic[1], b_q12[1], conic[2]));
    write_two(out, to, 0);
    return signs_of(m.beyond);
}

void AXES(const t3r_projection *p, const t3r_gaussian *gaussians, const t3r_splat *splats, uint32_t count,
          t3r_refine_sums *sums)
{
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        for (uint32_t beyond = axes_batch(p, gaussians + i, splats + i, sums + i); beyond != 0; beyond &= beyond - 1) {
            const uint32_t lane = i + (uint32_t)__builtin_ctz(beyond);
            t3r_axes_c(p, &gaussians[lane], &splats[lane], 1, &sums[lane]);
        }
    }
    t3r_axes_c(p, gaussians + i, splats + i, count - i, sums + i);
}

#endif
