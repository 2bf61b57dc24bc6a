/* SPDX-License-Identifier: Apache-2.0 */
/* Shifts of each lane by its own count, for instruction sets that have them: counts beyond the bits give 0, or the
 * sign. */
#ifndef T3R_KERNELS_LANES_SHIFTS_H
#define T3R_KERNELS_LANES_SHIFTS_H

static inline T3R_LANES_TARGET lanes left_each(lanes x, lanes by)
{
    return OF_LANES(sllv_epi32)(x, by);
}

static inline T3R_LANES_TARGET lanes right_each(lanes x, lanes by)
{
    return OF_LANES(srlv_epi32)(x, by);
}

static inline T3R_LANES_TARGET lanes signed_right_each(lanes x, lanes by)
{
    return OF_LANES(srav_epi32)(x, by);
}

static inline T3R_LANES_TARGET wide right_by(wide x, wide by)
{
    return (wide){OF_LANES(srlv_epi64)(x.even, by.even), OF_LANES(srlv_epi64)(x.odd, by.odd)};
}

static inline T3R_LANES_TARGET wide left_by(wide x, wide by)
{
    return (wide){OF_LANES(sllv_epi64)(x.even, by.even), OF_LANES(sllv_epi64)(x.odd, by.odd)};
}

#endif
