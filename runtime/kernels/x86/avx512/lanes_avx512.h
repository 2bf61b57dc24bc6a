/* SPDX-License-Identifier: Apache-2.0 */
/* Sixteen lanes of 32 bits, or 64 for products, in vectors of AVX-512. */
#ifndef T3R_KERNELS_X86_LANES_AVX512_H
#define T3R_KERNELS_X86_LANES_AVX512_H

#include "kernels/x86/quads.h"
#include "kernels/x86/variants.h"

#define LANES 16
#define T3R_LANES_TARGET T3R_AVX512
#define OF_LANES(instruction) _mm512_##instruction
#define OF_ALL_BITS(instruction) _mm512_##instruction##_si512
#define T3R_LANES_BY_FACTORS 0
#define ALL_64 _mm512_set1_epi64

typedef __m512i lanes; /* of 32 bits */
typedef __m512i_u lanes_there;

#include "kernels/lanes/vectors/operations.h"

#include "kernels/lanes/vectors/even_odd.h"

#include "kernels/lanes/vectors/shifts.h"

/* Joins four vectors of 128 bits. */
static inline T3R_AVX512 lanes joined(const quad x[LANES / 4])
{
    lanes all = _mm512_inserti32x4(_mm512_castsi128_si512(x[0]), x[1], 1);
    all = _mm512_inserti32x4(all, x[2], 2);
    return _mm512_inserti32x4(all, x[3], 3);
}

static inline T3R_AVX512 quad part(lanes x, int i)
{
    const __m256i half = i < 2 ? _mm512_castsi512_si256(x) : _mm512_extracti64x4_epi64(x, 1);
    return i % 2 == 0 ? _mm256_castsi256_si128(half) : _mm256_extracti128_si256(half, 1);
}

/* Return all bits set where a is greater, or equal. */
static inline T3R_AVX512 lanes greater(lanes a, lanes b)
{
    return _mm512_movm_epi32(_mm512_cmpgt_epi32_mask(a, b));
}

static inline T3R_AVX512 lanes equal(lanes a, lanes b)
{
    return _mm512_movm_epi32(_mm512_cmpeq_epi32_mask(a, b));
}

/* Returns a >= b for unsigned numbers. */
static inline T3R_AVX512 lanes at_least(lanes a, lanes b)
{
    return _mm512_movm_epi32(_mm512_cmpge_epu32_mask(a, b));
}

/* Returns b where the mask has all bits, else a. */
static inline T3R_AVX512 lanes chosen(lanes mask, lanes b, lanes a)
{
    return _mm512_mask_blend_epi32(_mm512_movepi32_mask(mask), a, b);
}

/* Returns one bit per lane, its sign. */
static inline T3R_AVX512 uint32_t signs_of(lanes x)
{
    return _mm512_movepi32_mask(x);
}

/* Return the low and the high halves of 64 bits. */
static inline T3R_AVX512 lanes low_of(wide x)
{
    return _mm512_mask_shuffle_epi32(x.even, 0xaaaa, x.odd, _MM_PERM_CCAA);
}

static inline T3R_AVX512 lanes high_of(wide x)
{
    return _mm512_mask_shuffle_epi32(x.odd, 0x5555, x.even, _MM_PERM_DDBB);
}

/* Shifts x in 1..2^31 - 1 left until bit 30 is its highest; *by: the shift, below twice the first step. */
static inline T3R_AVX512 lanes normal_of(lanes x, int first_step, lanes *by)
{
    (void)first_step;
    *by = subtract(_mm512_lzcnt_epi32(x), all(1));
    return _mm512_sllv_epi32(x, *by);
}

/* Looks up entries 0..127 of a table in four pairs of vectors; two bits of the index select the pair. */
static inline T3R_AVX512 lanes entry_of(const uint32_t *table, lanes index)
{
    lanes found[4];
    for (int i = 0; i < 4; i++) {
        const lanes lower = _mm512_loadu_si512(table + 32 * i), upper = _mm512_loadu_si512(table + 32 * i + 16);
        found[i] = _mm512_permutex2var_epi32(lower, index, upper);
    }
    const __mmask16 is_odd = _mm512_test_epi32_mask(index, all(32)), is_high = _mm512_test_epi32_mask(index, all(64));
    const lanes low = _mm512_mask_blend_epi32(is_odd, found[0], found[1]);
    return _mm512_mask_blend_epi32(is_high, low, _mm512_mask_blend_epi32(is_odd, found[2], found[3]));
}

/* Looks up entries 0..127 of a table of 129, and the next ones. */
static inline T3R_AVX512 void look_up(const uint32_t *table, lanes index, lanes *entry, lanes *next)
{
    *entry = entry_of(table, index);
    *next = entry_of(table + 1, index);
}

#endif
