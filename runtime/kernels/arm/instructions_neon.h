/* SPDX-License-Identifier: Apache-2.0 */
/* The instructions that lanes/ uses, in NEON, under their x86 names. */
#ifndef T3R_KERNELS_ARM_INSTRUCTIONS_NEON_H
#define T3R_KERNELS_ARM_INSTRUCTIONS_NEON_H

#include <arm_neon.h>

#include "kernels/lanes/vectors/inline.h"

#define OF_LANES(instruction) neon_##instruction
#define OF_QUAD(instruction) neon_##instruction
#define OF_ALL_BITS(instruction) neon_##instruction##_si128

typedef int32x4_t quad;
typedef int32_t quad_there __attribute__((vector_size(16), aligned(1), may_alias));

#define U32 vreinterpretq_u32_s32
#define S16 vreinterpretq_s16_s32
#define U16 vreinterpretq_u16_s32
#define FROM_U32 vreinterpretq_s32_u32
#define FROM_S16 vreinterpretq_s32_s16
#define FROM_U16 vreinterpretq_s32_u16

/* Defines an operation of NEON on vectors of another type. */
#define NEON(name, operation, to, from)                                                                                \
    T3R_LANES_INLINE quad neon_##name(quad a, quad b)                                                                  \
    {                                                                                                                  \
        return from(operation(to(a), to(b)));                                                                          \
    }                                                                                                                  \
    _Static_assert(sizeof(quad) == 16, "whole vectors") /* takes the semicolon */
#define AS_IT_IS(x) (x)

NEON(and_si128, vandq_s32, AS_IT_IS, AS_IT_IS);
NEON(or_si128, vorrq_s32, AS_IT_IS, AS_IT_IS);
NEON(xor_si128, veorq_s32, AS_IT_IS, AS_IT_IS);
NEON(add_epi32, vaddq_s32, AS_IT_IS, AS_IT_IS);
NEON(sub_epi32, vsubq_s32, AS_IT_IS, AS_IT_IS);
NEON(mullo_epi32, vmulq_s32, AS_IT_IS, AS_IT_IS);
NEON(min_epi32, vminq_s32, AS_IT_IS, AS_IT_IS);
NEON(max_epi32, vmaxq_s32, AS_IT_IS, AS_IT_IS);
NEON(min_epu32, vminq_u32, U32, FROM_U32);
NEON(max_epu32, vmaxq_u32, U32, FROM_U32);
NEON(cmpgt_epi32, vcgtq_s32, AS_IT_IS, FROM_U32);
NEON(cmpeq_epi32, vceqq_s32, AS_IT_IS, FROM_U32);
NEON(add_epi64, vaddq_s64, vreinterpretq_s64_s32, vreinterpretq_s32_s64);
NEON(sub_epi64, vsubq_s64, vreinterpretq_s64_s32, vreinterpretq_s32_s64);
NEON(add_epi16, vaddq_s16, S16, FROM_S16);
NEON(sub_epi16, vsubq_s16, S16, FROM_S16);
NEON(mullo_epi16, vmulq_s16, S16, FROM_S16);
NEON(unpacklo_epi16, vzip1q_s16, S16, FROM_S16);
NEON(unpackhi_epi16, vzip2q_s16, S16, FROM_S16);
NEON(unpacklo_epi32, vzip1q_s32, AS_IT_IS, AS_IT_IS);
NEON(unpackhi_epi32, vzip2q_s32, AS_IT_IS, AS_IT_IS);
NEON(unpacklo_epi64, vzip1q_s64, vreinterpretq_s64_s32, vreinterpretq_s32_s64);
NEON(unpackhi_epi64, vzip2q_s64, vreinterpretq_s64_s32, vreinterpretq_s32_s64);
NEON(shuffle_epi8, vqtbl1q_u8, vreinterpretq_u8_s32, vreinterpretq_s32_u8);
#undef NEON

/* -1 times -1 wraps to -1; the instruction saturates instead. */
T3R_LANES_INLINE quad neon_mulhrs_epi16(quad a, quad b)
{
    const int16x8_t least = vdupq_n_s16(INT16_MIN);
    const uint16x8_t beyond = vandq_u16(vceqq_s16(S16(a), least), vceqq_s16(S16(b), least));
    return FROM_S16(veorq_s16(vqrdmulhq_s16(S16(a), S16(b)), vreinterpretq_s16_u16(beyond)));
}

T3R_LANES_INLINE quad neon_loadu_si128(const quad_there *from)
{
    return *from;
}

T3R_LANES_INLINE void neon_storeu_si128(quad_there *to, quad x)
{
    *to = x;
}

T3R_LANES_INLINE quad neon_andnot_si128(quad a, quad b)
{
    return vbicq_s32(b, a);
}

T3R_LANES_INLINE quad neon_blendv_epi8(quad a, quad b, quad mask)
{
    return vbslq_s32(U32(mask), b, a);
}

/* Joins the even 16-bit numbers of one and the odd ones of the other: of_b is 0x55 or 0xaa and selects those of b. */
T3R_LANES_INLINE quad neon_blend_epi16(quad a, quad b, int of_b)
{
    return vbslq_s32(vdupq_n_u32(of_b == 0xaa ? 0xffff0000u : 0xffffu), b, a);
}

T3R_LANES_INLINE quad neon_set1_epi32(int32_t x)
{
    return vdupq_n_s32(x);
}

T3R_LANES_INLINE quad neon_set1_epi16(int16_t x)
{
    return FROM_S16(vdupq_n_s16(x));
}

#define neon_setr_epi32(...) ((int32x4_t){__VA_ARGS__})
#define neon_setr_epi16(...) FROM_S16(((int16x8_t){__VA_ARGS__}))
#define neon_setr_epi8(...) vreinterpretq_s32_s8(((int8x16_t){__VA_ARGS__}))

/* Shift by a constant less than the bits. */
T3R_LANES_INLINE quad neon_slli_epi32(quad x, int by)
{
    return FROM_U32(U32(x) << by);
}

T3R_LANES_INLINE quad neon_srli_epi32(quad x, int by)
{
    return FROM_U32(U32(x) >> by);
}

T3R_LANES_INLINE quad neon_srai_epi32(quad x, int by)
{
    return x >> by;
}

T3R_LANES_INLINE quad neon_srli_epi16(quad x, int by)
{
    return FROM_U16(U16(x) >> (int16_t)by);
}

T3R_LANES_INLINE quad neon_slli_epi64(quad x, int by)
{
    return vreinterpretq_s32_s64(vreinterpretq_s64_s32(x) << by);
}

T3R_LANES_INLINE quad neon_srli_epi64(quad x, int by)
{
    return vreinterpretq_s32_u64(vreinterpretq_u64_s32(x) >> by);
}

#define neon_srli_si128(x, bytes) vreinterpretq_s32_u8(vextq_u8(vreinterpretq_u8_s32(x), vdupq_n_u8(0), bytes))

/* Shift by the first number of a vector, less than the bits. */
T3R_LANES_INLINE quad neon_sll_epi16(quad x, quad by)
{
    return FROM_S16(vshlq_s16(S16(x), vdupq_laneq_s16(S16(by), 0)));
}

T3R_LANES_INLINE quad neon_sra_epi16(quad x, quad by)
{
    return FROM_S16(vshlq_s16(S16(x), vdupq_laneq_s16(vnegq_s16(S16(by)), 0)));
}

T3R_LANES_INLINE quad neon_srl_epi32(quad x, quad by)
{
    return FROM_U32(vshlq_u32(U32(x), vdupq_laneq_s32(vnegq_s32(by), 0)));
}

T3R_LANES_INLINE quad neon_sra_epi32(quad x, quad by)
{
    return vshlq_s32(x, vdupq_laneq_s32(vnegq_s32(by), 0));
}

T3R_LANES_INLINE quad neon_abs_epi32(quad x)
{
    return vabsq_s32(x);
}

/* Multiply the low halves of 64 bits. */
T3R_LANES_INLINE quad neon_mul_epi32(quad a, quad b)
{
    return vreinterpretq_s32_s64(vmull_s32(vmovn_s64(vreinterpretq_s64_s32(a)), vmovn_s64(vreinterpretq_s64_s32(b))));
}

T3R_LANES_INLINE quad neon_madd_epi16(quad a, quad b)
{
    const int16x8_t x = S16(a), y = S16(b);
    return vpaddq_s32(vmull_s16(vget_low_s16(x), vget_low_s16(y)), vmull_high_s16(x, y));
}

T3R_LANES_INLINE quad neon_packs_epi32(quad a, quad b)
{
    return FROM_S16(vqmovn_high_s32(vqmovn_s32(a), b));
}

T3R_LANES_INLINE quad neon_packs_epi16(quad a, quad b)
{
    return vreinterpretq_s32_s8(vqmovn_high_s16(vqmovn_s16(S16(a)), S16(b)));
}

T3R_LANES_INLINE int32_t neon_cvtsi128_si32(quad x)
{
    return vgetq_lane_s32(x, 0);
}

T3R_LANES_INLINE int64_t neon_cvtsi128_si64(quad x)
{
    return vgetq_lane_s64(vreinterpretq_s64_s32(x), 0);
}

T3R_LANES_INLINE quad neon_cvtsi32_si128(int32_t x)
{
    return vsetq_lane_s32(x, vdupq_n_s32(0), 0);
}

#endif
