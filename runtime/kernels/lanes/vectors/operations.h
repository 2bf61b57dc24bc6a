/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the headers of lanes, which name the type, the target and the prefix of its instructions. */
#ifndef T3R_KERNELS_LANES_OPERATIONS_H
#define T3R_KERNELS_LANES_OPERATIONS_H

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

/* Returns the bits of b that are not in a. */
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

/* Multiplies modulo 2^32. */
static inline T3R_LANES_TARGET lanes multiply(lanes a, lanes b)
{
    return OF_LANES(mullo_epi32)(a, b);
}

#endif
