/* SPDX-License-Identifier: Apache-2.0 */
/* A packed layer, four outputs a vector, by dot products: four activations, in all lanes, times four weights of each.
 */
#include "variants.h"

#ifdef T3R_NEON_LEARNED

/* The compiler or its assembler needs the dot-product target: clang's assembler takes the function's target, with
 * which gcc would not inline functions compiled for less. */
#if defined(__ARM_FEATURE_DOTPROD)
#define FOR_DOT_PRODUCTS
#elif defined(__clang__)
#define T3R_LANES_TARGET __attribute__((target("dotprod")))
#define FOR_DOT_PRODUCTS
#else
#define FOR_DOT_PRODUCTS ".arch armv8.2-a+dotprod\n\t"
#endif

#include "lanes_neon.h"

#define TAPS 4u
#define MOST_SUMS 16u

typedef uint8_t activation;
typedef int32x4_t ints;

/* Strips of bytes hold activations + 128. */
T3R_LANES_INLINE lanes taps_at(const activation *x)
{
    uint32_t four;
    __builtin_memcpy(&four, x, sizeof four);
    return different(vreinterpretq_s32_u32(vdupq_n_u32(four)), all((int32_t)0x80808080u));
}

T3R_LANES_INLINE lanes load_weights(const uint8_t *from)
{
    return load(from);
}

T3R_LANES_INLINE T3R_LANES_TARGET void add_products(ints *sum, lanes taps, lanes weights)
{
    __asm__(FOR_DOT_PRODUCTS "sdot %0.4s, %1.16b, %2.16b" : "+w"(*sum) : "w"(taps), "w"(weights));
}

#define PACK_LAYER t3r_pack_layer_dotprod
#define CONVOLVE_PACKED t3r_convolve_packed_dotprod
#include "kernels/lanes/convolve_packed_lanes.h"

#else
typedef int t3r_no_convolve_packed_dotprod; /* a file may not be empty */
#endif
