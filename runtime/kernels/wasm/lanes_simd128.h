/* SPDX-License-Identifier: Apache-2.0 */
/* Four lanes of 32 bits, or 64 for products, in vectors of WebAssembly. */
#ifndef T3R_KERNELS_WASM_LANES_SIMD128_H
#define T3R_KERNELS_WASM_LANES_SIMD128_H

#include "instructions_simd128.h"
#include "variants.h"

#define LANES 4
#define T3R_LANES_TARGET /* the whole build has these instructions */
#define OF_LANES(instruction) simd_##instruction
#define OF_QUAD(instruction) simd_##instruction
#define OF_ALL_BITS(instruction) simd_##instruction
#define T3R_LANES_BY_FACTORS 1
#define ALL_64 wasm_i64x2_splat

typedef quad lanes; /* of 32 bits */
typedef quad lanes_there;

T3R_LANES_INLINE quad load_quad(const void *from)
{
    return wasm_v128_load(from);
}

T3R_LANES_INLINE void store_quad(void *to, quad x)
{
    wasm_v128_store(to, x);
}

/* Load the first 64 bits, or 32; the others are 0. */
T3R_LANES_INLINE quad load_half_quad(const void *from)
{
    return wasm_v128_load64_zero(from);
}

T3R_LANES_INLINE void store_half_quad(void *to, quad x)
{
    wasm_v128_store64_lane(to, x, 0);
}

T3R_LANES_INLINE quad load_quarter_quad(const void *from)
{
    return wasm_v128_load32_zero(from);
}

T3R_LANES_INLINE void store_quarter_quad(void *to, quad x)
{
    wasm_v128_store32_lane(to, x, 0);
}

/* Returns the least of four numbers of 32 bits. */
T3R_LANES_INLINE int32_t least_of_quad(quad x)
{
    x = wasm_i32x4_min(x, wasm_i32x4_shuffle(x, x, 2, 3, 0, 1));
    return wasm_i32x4_extract_lane(wasm_i32x4_min(x, wasm_i32x4_shuffle(x, x, 1, 0, 3, 2)), 0);
}

#include "kernels/lanes/vectors/operations.h"

#include "kernels/lanes/vectors/even_odd.h"
#include "kernels/lanes/vectors/masks.h"

#include "kernels/lanes/vectors/alternating.h"

T3R_LANES_INLINE lanes alternating(lanes even, lanes odd)
{
    return wasm_i32x4_shuffle(even, odd, 0, 5, 2, 7);
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
    return (uint32_t)wasm_i32x4_bitmask(x);
}

/* Returns 2^exponent for exponents 0..31, by conversion from floating point. */
T3R_LANES_INLINE lanes power_of_two(lanes exponent)
{
    return wasm_u32x4_trunc_sat_f32x4(wasm_i32x4_shl(add(exponent, all(127)), 23));
}

/* Shift each lane by its own count, by multiplication, because there is no instruction. Counts beyond the bits give 0,
 * or the sign. */
T3R_LANES_INLINE lanes left_each(lanes x, lanes by)
{
    return both(multiply(x, power_of_two(both(by, all(31)))), wasm_u32x4_lt(by, all(32)));
}

T3R_LANES_INLINE lanes right_each(lanes x, lanes by)
{
    const lanes factor = power_of_two(without(by, all(31)));
    const lanes shifted = wasm_i32x4_shuffle(wasm_u64x2_shr(wasm_u64x2_extmul_low_u32x4(x, factor), 31),
                                             wasm_u64x2_shr(wasm_u64x2_extmul_high_u32x4(x, factor), 31), 0, 2, 4, 6);
    return both(shifted, wasm_u32x4_lt(by, all(32)));
}

T3R_LANES_INLINE lanes signed_right_each(lanes x, lanes by)
{
    const lanes sign = wasm_i32x4_shr(x, 31);
    return different(right_each(different(x, sign), by), sign);
}

/* Shift two 64-bit numbers in the same way. */
T3R_LANES_INLINE uint64_t right_64(uint64_t x, uint64_t by)
{
    return by < 64 ? x >> by : 0;
}

T3R_LANES_INLINE uint64_t left_64(uint64_t x, uint64_t by)
{
    return by < 64 ? x << by : 0;
}

#define SHIFTED_64(shift, x, by)                                                                                       \
    wasm_u64x2_make(shift(wasm_u64x2_extract_lane(x, 0), wasm_u64x2_extract_lane(by, 0)),                              \
                    shift(wasm_u64x2_extract_lane(x, 1), wasm_u64x2_extract_lane(by, 1)))

T3R_LANES_INLINE wide right_by(wide x, wide by)
{
    return (wide){SHIFTED_64(right_64, x.even, by.even), SHIFTED_64(right_64, x.odd, by.odd)};
}

T3R_LANES_INLINE wide left_by(wide x, wide by)
{
    return (wide){SHIFTED_64(left_64, x.even, by.even), SHIFTED_64(left_64, x.odd, by.odd)};
}

/* Shifts x in 1..2^31 - 1 left until bit 30 is its highest; *by: the shift. The exponent of the number converted to
 * floating point gives the shift; bits below a 1 are cleared first, so that rounding cannot carry. */
T3R_LANES_INLINE lanes normal_of(lanes x, int first_step, lanes *by)
{
    (void)first_step;
    const lanes number = wasm_f32x4_convert_i32x4(without(wasm_u32x4_shr(x, 1), x));
    *by = subtract(all(127 + 30), wasm_u32x4_shr(number, 23));
    return multiply(x, power_of_two(*by));
}

/* Repeats the first 32 bits in all lanes. */
T3R_LANES_INLINE lanes first_of(quad x)
{
    return wasm_i32x4_shuffle(x, x, 0, 0, 0, 0);
}

/* Loads pairs of signed 8-bit numbers, widened to 16. */
T3R_LANES_INLINE lanes load_8(const uint8_t *from)
{
    return wasm_i16x8_load8x8(from);
}

/* Load and store 16-bit numbers; stored ones are below 2^16. */
T3R_LANES_INLINE lanes load_16(const uint16_t *from)
{
    return wasm_u32x4_load16x4(from);
}

T3R_LANES_INLINE void store_16(uint16_t *to, lanes x)
{
    store_half_quad(to, wasm_u16x8_narrow_i32x4(x, x));
}

#endif
