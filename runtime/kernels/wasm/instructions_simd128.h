/* SPDX-License-Identifier: Apache-2.0 */
/* WebAssembly's vector instructions under the names that kernels/lanes uses: those of SSE4.1. Macros, because
 * tools/amalgamate, which renames functions, cannot rename names that are pasted together. */
#ifndef T3R_KERNELS_WASM_INSTRUCTIONS_SIMD128_H
#define T3R_KERNELS_WASM_INSTRUCTIONS_SIMD128_H

#include <wasm_simd128.h>

#include "kernels/lanes/vectors/inline.h"

typedef v128_t quad;

#define simd_and wasm_v128_and
#define simd_or wasm_v128_or
#define simd_or_si128 wasm_v128_or
#define simd_xor wasm_v128_xor
#define simd_add_epi16 wasm_i16x8_add
#define simd_add_epi32 wasm_i32x4_add
#define simd_add_epi64 wasm_i64x2_add
#define simd_sub_epi16 wasm_i16x8_sub
#define simd_sub_epi32 wasm_i32x4_sub
#define simd_sub_epi64 wasm_i64x2_sub
#define simd_mullo_epi16 wasm_i16x8_mul
#define simd_mullo_epi32 wasm_i32x4_mul
#define simd_madd_epi16 wasm_i32x4_dot_i16x8
#define simd_mulhrs_epi16 rounded_products
#define simd_avg_epu16 wasm_u16x8_avgr
#define simd_min_epu16 wasm_u16x8_min
#define simd_max_epu16 wasm_u16x8_max
#define simd_min_epi32 wasm_i32x4_min
#define simd_max_epi32 wasm_i32x4_max
#define simd_min_epu32 wasm_u32x4_min
#define simd_max_epu32 wasm_u32x4_max
#define simd_cmpeq_epi16 wasm_i16x8_eq
#define simd_cmpeq_epi32 wasm_i32x4_eq
#define simd_cmpgt_epi32 wasm_i32x4_gt
#define simd_packs_epi16 wasm_i8x16_narrow_i16x8
#define simd_packs_epi32 wasm_i16x8_narrow_i32x4
#define simd_packus_epi32 wasm_u16x8_narrow_i32x4
#define simd_shuffle_epi8 wasm_i8x16_swizzle
#define simd_abs_epi32 wasm_i32x4_abs

/* Shift by less than the bits of a lane, as WebAssembly counts modulo these: by a constant, or by the first lane. */
#define simd_srli_epi16 wasm_u16x8_shr
#define simd_slli_epi32 wasm_i32x4_shl
#define simd_srli_epi32 wasm_u32x4_shr
#define simd_srai_epi32 wasm_i32x4_shr
#define simd_slli_epi64 wasm_i64x2_shl
#define simd_srli_epi64 wasm_u64x2_shr
#define FIRST_COUNT(by) ((uint32_t)wasm_i32x4_extract_lane(by, 0))
#define simd_sll_epi16(x, by) wasm_i16x8_shl(x, FIRST_COUNT(by))
#define simd_sra_epi16(x, by) wasm_i16x8_shr(x, FIRST_COUNT(by))
#define simd_srl_epi32(x, by) wasm_u32x4_shr(x, FIRST_COUNT(by))
#define simd_sra_epi32(x, by) wasm_i32x4_shr(x, FIRST_COUNT(by))

#define simd_set1_epi16 wasm_i16x8_splat
#define simd_set1_epi32 wasm_i32x4_splat
#define simd_setr_epi8 wasm_i8x16_make
#define simd_setr_epi16 wasm_i16x8_make
#define simd_setr_epi32 wasm_i32x4_make
#define simd_cvtsi128_si32(x) wasm_i32x4_extract_lane(x, 0)
#define simd_cvtsi128_si64(x) wasm_i64x2_extract_lane(x, 0)
#define simd_loadu wasm_v128_load
#define simd_storeu wasm_v128_store

#define simd_unpacklo_epi16(a, b) wasm_i16x8_shuffle(a, b, 0, 8, 1, 9, 2, 10, 3, 11)
#define simd_unpackhi_epi16(a, b) wasm_i16x8_shuffle(a, b, 4, 12, 5, 13, 6, 14, 7, 15)
#define simd_unpacklo_epi32(a, b) wasm_i32x4_shuffle(a, b, 0, 4, 1, 5)
#define simd_unpackhi_epi32(a, b) wasm_i32x4_shuffle(a, b, 2, 6, 3, 7)
#define simd_unpacklo_epi64(a, b) wasm_i64x2_shuffle(a, b, 0, 2)
#define simd_unpackhi_epi64(a, b) wasm_i64x2_shuffle(a, b, 1, 3)

/* Selects words of b where the constant has a bit. */
#define SIMD_WORD(bits, i) ((int16_t) - ((bits) >> (i)&1))
#define simd_blend_epi16(a, b, bits)                                                                                   \
    wasm_v128_bitselect(b, a,                                                                                          \
                        wasm_i16x8_const(SIMD_WORD(bits, 0), SIMD_WORD(bits, 1), SIMD_WORD(bits, 2),                   \
                                         SIMD_WORD(bits, 3), SIMD_WORD(bits, 4), SIMD_WORD(bits, 5),                   \
                                         SIMD_WORD(bits, 6), SIMD_WORD(bits, 7)))

/* Shifts right by a constant number of bytes. */
#define simd_srli_si128(x, by)                                                                                         \
    wasm_i8x16_shuffle(x, wasm_i32x4_const_splat(0), (by), (by) + 1, (by) + 2, (by) + 3, (by) + 4, (by) + 5, (by) + 6, \
                       (by) + 7, (by) + 8, (by) + 9, (by) + 10, (by) + 11, (by) + 12, (by) + 13, (by) + 14, (by) + 15)

#define simd_andnot(a, b) wasm_v128_andnot(b, a)
#define simd_blendv_epi8(a, b, mask) wasm_v128_bitselect(b, a, mask)
#define simd_cvtsi32_si128(x) wasm_i32x4_make(x, 0, 0, 0)
#define simd_mulhi_epu16 high_products
#define simd_mul_epi32(a, b) wasm_i64x2_extmul_low_i32x4(even_first(a), even_first(b))
#define simd_mul_epu32(a, b) wasm_u64x2_extmul_low_u32x4(even_first(a), even_first(b))

/* -1 times -1 wraps to -1; the instruction saturates instead. */
T3R_LANES_INLINE quad rounded_products(quad a, quad b)
{
    const quad least = wasm_i16x8_const_splat(INT16_MIN);
    const quad beyond = wasm_v128_and(wasm_i16x8_eq(a, least), wasm_i16x8_eq(b, least));
    return wasm_v128_xor(wasm_i16x8_q15mulr_sat(a, b), beyond);
}

T3R_LANES_INLINE quad high_products(quad a, quad b)
{
    return wasm_i16x8_shuffle(wasm_u32x4_extmul_low_u16x8(a, b), wasm_u32x4_extmul_high_u16x8(a, b), 1, 3, 5, 7, 9, 11,
                              13, 15);
}

T3R_LANES_INLINE quad even_first(quad x)
{
    return wasm_i32x4_shuffle(x, x, 0, 2, 0, 2);
}

#endif
