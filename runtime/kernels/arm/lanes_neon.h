/* SPDX-License-Identifier: Apache-2.0 */
/* Four lanes of 32 bits, or 64 for products, in vectors of NEON. */
#ifndef T3R_KERNELS_ARM_LANES_NEON_H
#define T3R_KERNELS_ARM_LANES_NEON_H

#include "instructions_neon.h"
#include "variants.h"

#define LANES 4
#ifndef T3R_LANES_TARGET
#define T3R_LANES_TARGET /* every processor of the architecture has NEON */
#endif
#define T3R_LANES_BY_FACTORS 0
#define ALL_64(x) vreinterpretq_s32_s64(vdupq_n_s64(x))

typedef quad lanes; /* of 32 bits */
typedef quad_there lanes_there;

#include "kernels/lanes/vectors/operations.h"

/* 64 bits of each lane. "even" are lanes 0 and 1, "odd" 2 and 3: products come in this order, on which kernels don't
 * depend. */
typedef struct wide {
    lanes even, odd;
} wide;

/* Puts each lane in the low half of its 64 bits; the high half is unused. */
T3R_LANES_INLINE wide spread(lanes x)
{
    return (wide){vzip1q_s32(x, x), vzip2q_s32(x, x)};
}

/* Puts each lane in the high half of its 64 bits, above 0. */
T3R_LANES_INLINE wide lifted(lanes x)
{
    return (wide){vzip1q_s32(all(0), x), vzip2q_s32(all(0), x)};
}

T3R_LANES_INLINE wide widened(lanes x)
{
    return (wide){vzip1q_s32(x, all(0)), vzip2q_s32(x, all(0))};
}

T3R_LANES_INLINE wide product(lanes a, lanes b)
{
    return (wide){vreinterpretq_s32_s64(vmull_s32(vget_low_s32(a), vget_low_s32(b))),
                  vreinterpretq_s32_s64(vmull_high_s32(a, b))};
}

T3R_LANES_INLINE wide unsigned_product(lanes a, lanes b)
{
    return (wide){vreinterpretq_s32_u64(vmull_u32(vget_low_u32(U32(a)), vget_low_u32(U32(b)))),
                  vreinterpretq_s32_u64(vmull_high_u32(U32(a), U32(b)))};
}

T3R_LANES_INLINE wide sum(wide a, wide b)
{
    return (wide){OF_LANES(add_epi64)(a.even, b.even), OF_LANES(add_epi64)(a.odd, b.odd)};
}

T3R_LANES_INLINE wide difference(wide a, wide b)
{
    return (wide){OF_LANES(sub_epi64)(a.even, b.even), OF_LANES(sub_epi64)(a.odd, b.odd)};
}

T3R_LANES_INLINE wide all_wide(int64_t x)
{
    return (wide){ALL_64(x), ALL_64(x)};
}

/* Shift as unsigned: only the bits that were there are valid. */
T3R_LANES_INLINE wide right(wide x, uint8_t shift)
{
    return (wide){OF_LANES(srli_epi64)(x.even, shift), OF_LANES(srli_epi64)(x.odd, shift)};
}

T3R_LANES_INLINE lanes low_of(wide x)
{
    return vuzp1q_s32(x.even, x.odd);
}

T3R_LANES_INLINE lanes high_of(wide x)
{
    return vuzp2q_s32(x.even, x.odd);
}

#include "kernels/lanes/vectors/masks.h"

T3R_LANES_INLINE quad load_quad(const void *from)
{
    return *(const quad_there *)from;
}

T3R_LANES_INLINE void store_quad(void *to, quad x)
{
    *(quad_there *)to = x;
}

/* Load the first 64 bits, or store 32; others are 0. */
T3R_LANES_INLINE quad load_half_quad(const void *from)
{
    return vreinterpretq_s32_u8(vcombine_u8(vld1_u8(from), vdup_n_u8(0)));
}

T3R_LANES_INLINE void store_half_quad(void *to, quad x)
{
    vst1_u8(to, vget_low_u8(vreinterpretq_u8_s32(x)));
}

T3R_LANES_INLINE void store_quarter_quad(void *to, quad x)
{
    const int32_t first = OF_LANES(cvtsi128_si32)(x);
    __builtin_memcpy(to, &first, sizeof first);
}

/* Returns the least of four numbers of 32 bits. */
T3R_LANES_INLINE int32_t least_of_quad(quad x)
{
    return vminvq_s32(x);
}

T3R_LANES_INLINE lanes joined(const quad x[LANES / 4])
{
    return x[0];
}

T3R_LANES_INLINE quad part(lanes x, int i)
{
    (void)i; /* 0 */
    return x;
}

/* Repeats 128 bits. */
T3R_LANES_INLINE lanes repeated(quad x)
{
    return x;
}

/* Returns one bit per lane, its sign. */
T3R_LANES_INLINE uint32_t signs_of(lanes x)
{
    return vaddvq_u32(vshlq_u32(vshrq_n_u32(U32(x), 31), (int32x4_t){0, 1, 2, 3}));
}

/* Shift each lane by its own count: counts beyond the bits give 0, or the sign. The instruction uses the last 8 bits
 * of the count, signed. */
T3R_LANES_INLINE lanes up_to_63(lanes by)
{
    return OF_LANES(min_epu32)(by, all(63));
}

T3R_LANES_INLINE lanes left_each(lanes x, lanes by)
{
    return FROM_U32(vshlq_u32(U32(x), up_to_63(by)));
}

T3R_LANES_INLINE lanes right_each(lanes x, lanes by)
{
    return FROM_U32(vshlq_u32(U32(x), vnegq_s32(up_to_63(by))));
}

T3R_LANES_INLINE lanes signed_right_each(lanes x, lanes by)
{
    return vshlq_s32(x, vnegq_s32(up_to_63(by)));
}

/* Limits two 64-bit counts below 2^32 in the same way: 64 gives 0. */
T3R_LANES_INLINE int64x2_t up_to_64(lanes by)
{
    return vreinterpretq_s64_s32(OF_LANES(min_epu32)(by, all(64)));
}

T3R_LANES_INLINE lanes shifted_64(lanes x, int64x2_t by)
{
    return vreinterpretq_s32_u64(vshlq_u64(vreinterpretq_u64_s32(x), by));
}

T3R_LANES_INLINE wide right_by(wide x, wide by)
{
    return (wide){shifted_64(x.even, vnegq_s64(up_to_64(by.even))), shifted_64(x.odd, vnegq_s64(up_to_64(by.odd)))};
}

T3R_LANES_INLINE wide left_by(wide x, wide by)
{
    return (wide){shifted_64(x.even, up_to_64(by.even)), shifted_64(x.odd, up_to_64(by.odd))};
}

/* Shifts x in 1..2^31 - 1 left until bit 30 is its highest; *by: the shift. */
T3R_LANES_INLINE lanes normal_of(lanes x, int first_step, lanes *by)
{
    (void)first_step;
    *by = subtract(vclzq_s32(x), all(1));
    return vshlq_s32(x, *by);
}

/* Loads two neighbours in the table, for each of two entries. */
T3R_LANES_INLINE quad pairs_at(const uint32_t *table, uint32_t first, uint32_t second)
{
    return FROM_U32(vcombine_u32(vld1_u32(table + first), vld1_u32(table + second)));
}

/* Looks up entries 0..127 of a table of 129, and the next ones. */
T3R_LANES_INLINE void look_up(const uint32_t *table, lanes index, lanes *entry, lanes *next)
{
    const uint32x4_t at = U32(index);
    const wide pair = {pairs_at(table, vgetq_lane_u32(at, 0), vgetq_lane_u32(at, 1)),
                       pairs_at(table, vgetq_lane_u32(at, 2), vgetq_lane_u32(at, 3))};
    *entry = low_of(pair);
    *next = high_of(pair);
}

#endif
