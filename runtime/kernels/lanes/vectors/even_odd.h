/* SPDX-License-Identifier: Apache-2.0 */
/* 64-bit numbers in the place of two lanes, for instructions that multiply even lanes. Included after operations.h. */
#ifndef T3R_KERNELS_LANES_EVEN_ODD_H
#define T3R_KERNELS_LANES_EVEN_ODD_H

/* 64 bits of each lane: of lanes 0, 2, 4... and of 1, 3, 5... */
typedef struct wide {
    lanes even, odd;
} wide;

static inline T3R_LANES_TARGET lanes odd_of(lanes x)
{
    return OF_LANES(srli_epi64)(x, 32);
}

/* Puts each lane in the low half of its 64 bits; the high half is unused. */
static inline T3R_LANES_TARGET wide spread(lanes x)
{
    return (wide){x, odd_of(x)};
}

/* Puts each lane in the high half of its 64 bits, above 0. */
static inline T3R_LANES_TARGET wide lifted(lanes x)
{
    return (wide){OF_LANES(slli_epi64)(x, 32), without(ALL_64(UINT32_MAX), x)};
}

static inline T3R_LANES_TARGET wide widened(lanes x)
{
    return (wide){both(x, ALL_64(UINT32_MAX)), odd_of(x)};
}

static inline T3R_LANES_TARGET wide product(lanes a, lanes b)
{
    return (wide){OF_LANES(mul_epi32)(a, b), OF_LANES(mul_epi32)(odd_of(a), odd_of(b))};
}

static inline T3R_LANES_TARGET wide unsigned_product(lanes a, lanes b)
{
    return (wide){OF_LANES(mul_epu32)(a, b), OF_LANES(mul_epu32)(odd_of(a), odd_of(b))};
}

static inline T3R_LANES_TARGET wide sum(wide a, wide b)
{
    return (wide){OF_LANES(add_epi64)(a.even, b.even), OF_LANES(add_epi64)(a.odd, b.odd)};
}

static inline T3R_LANES_TARGET wide difference(wide a, wide b)
{
    return (wide){OF_LANES(sub_epi64)(a.even, b.even), OF_LANES(sub_epi64)(a.odd, b.odd)};
}

static inline T3R_LANES_TARGET wide all_wide(int64_t x)
{
    return (wide){ALL_64(x), ALL_64(x)};
}

/* Shifts as unsigned: only the bits that were there are valid. */
static inline T3R_LANES_TARGET wide right(wide x, uint8_t shift)
{
    return (wide){OF_LANES(srli_epi64)(x.even, shift), OF_LANES(srli_epi64)(x.odd, shift)};
}

#endif
