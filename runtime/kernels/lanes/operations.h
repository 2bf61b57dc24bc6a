/* What the headers of lanes share: they name the type, the target and how its instructions begin. */
#ifndef T3R_KERNELS_LANES_OPERATIONS_H
#define T3R_KERNELS_LANES_OPERATIONS_H

/* 64 bits of each lane: of lanes 0, 2, 4... and of 1, 3, 5... */
typedef struct wide {
    lanes even, odd;
} wide;

static inline T3R_LANES_TARGET lanes load(const void *from)
{
    return OF_ALL_BITS(loadu)((const lanes_there *)from);
}

static inline T3R_LANES_TARGET void store(void *to, lanes x)
{
    OF_ALL_BITS(storeu)((lanes_there *)to, x);
}

static inline T3R_LANES_TARGET lanes both(lanes a, lanes b)
{
    return OF_ALL_BITS(and)(a, b);
}

static inline T3R_LANES_TARGET lanes either(lanes a, lanes b)
{
    return OF_ALL_BITS(or)(a, b);
}

static inline T3R_LANES_TARGET lanes different(lanes a, lanes b)
{
    return OF_ALL_BITS(xor)(a, b);
}

/* Bits of b that a has not. */
static inline T3R_LANES_TARGET lanes without(lanes a, lanes b)
{
    return OF_ALL_BITS(andnot)(a, b);
}

static inline T3R_LANES_TARGET lanes all(int32_t x)
{
    return OF_LANES(set1_epi32)(x);
}

static inline T3R_LANES_TARGET lanes add(lanes a, lanes b)
{
    return OF_LANES(add_epi32)(a, b);
}

static inline T3R_LANES_TARGET lanes subtract(lanes a, lanes b)
{
    return OF_LANES(sub_epi32)(a, b);
}

/* Modulo 2^32. */
static inline T3R_LANES_TARGET lanes multiply(lanes a, lanes b)
{
    return OF_LANES(mullo_epi32)(a, b);
}

static inline T3R_LANES_TARGET lanes odd_of(lanes x)
{
    return OF_LANES(srli_epi64)(x, 32);
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

/* Unsigned shifts: of the result only what bits had is right. */
static inline T3R_LANES_TARGET wide right(wide x, uint8_t shift)
{
    return (wide){OF_LANES(srli_epi64)(x.even, shift), OF_LANES(srli_epi64)(x.odd, shift)};
}

#endif
