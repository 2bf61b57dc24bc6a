/* SPDX-License-Identifier: Apache-2.0 */
/* Hashes blocks of 512 bytes. A step of the hash is h' = (h ^ b) p = (h + d) p, where d = (l ^ b) - l and l is the low
 * byte of h. So over n bytes h' = h p^n + sum of d_i p^(n - i) modulo 2^64, once all l_i are known.
 *
 * The low bytes follow l' = (l ^ b) 0xb3 modulo 256. Bit k of the product is bit k of l ^ b plus the carry from lower
 * bits. So the bits of all low bytes are found plane by plane, from the lowest up: each is a running exclusive or. A
 * plane is eight 64-bit words, with one bit per byte. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86_OPTIMIZED

#include "kernels/hash_bytes.h"
#include "kernels/x86/intrinsics.h"

#define WORDS 8u  /* in a plane */
#define WORD 64u  /* bytes that a word represents */
#define PLANES 8u /* bits of a byte */
#define GROUP 8u  /* sums side by side */

/* Powers of the prime, modulo 2^64. */
#define P1_ UINT64_C(0x100000001b3)
#define P2_ (P1_ * P1_)
#define P4_ (P2_ * P2_)
#define P8_ (P4_ * P4_)
#define P16_ (P8_ * P8_)
#define P32_ (P16_ * P16_)
#define P64_ (P32_ * P32_)
#define PART_(n, bit) (((n)&bit) != 0 ? P##bit##_ : 1)
#define POWER_(n) PART_(n, 1) * PART_(n, 2) * PART_(n, 4) * PART_(n, 8) * PART_(n, 16) * PART_(n, 32) * PART_(n, 64)
#define EIGHT_(n)                                                                                                      \
    POWER_(n), POWER_(n - 1), POWER_(n - 2), POWER_(n - 3), POWER_(n - 4), POWER_(n - 5), POWER_(n - 6), POWER_(n - 7)

/* p^(64 - i) for each byte i of a word. */
static const uint64_t powers[WORD] = {EIGHT_(64), EIGHT_(56), EIGHT_(48), EIGHT_(40),
                                      EIGHT_(32), EIGHT_(24), EIGHT_(16), EIGHT_(8)};

/* Sets bit i of each word to the exclusive or of its bits 0..i. */
static inline T3R_AVX512 __m512i running(__m512i bits)
{
    bits = _mm512_xor_si512(bits, _mm512_slli_epi64(bits, 1));
    bits = _mm512_xor_si512(bits, _mm512_slli_epi64(bits, 2));
    bits = _mm512_xor_si512(bits, _mm512_slli_epi64(bits, 4));
    bits = _mm512_xor_si512(bits, _mm512_slli_epi64(bits, 8));
    bits = _mm512_xor_si512(bits, _mm512_slli_epi64(bits, 16));
    return _mm512_xor_si512(bits, _mm512_slli_epi64(bits, 32));
}

static inline T3R_AVX512 __m512i exclusive_or(__m512i a, __m512i b, __m512i c)
{
    return _mm512_ternarylogic_epi64(a, b, c, 0x96);
}

static inline T3R_AVX512 __m512i majority(__m512i a, __m512i b, __m512i c)
{
    return _mm512_ternarylogic_epi64(a, b, c, 0xe8);
}

/* Converts a plane of changes to the plane itself: before each byte, the exclusive or of `before` and all changes up
 * to there. `before` becomes the value after the last byte. */
static inline T3R_AVX512 __m512i accumulated(__m512i change, uint32_t *before)
{
    const __m512i in_word = running(change);
    uint32_t words = _mm512_movepi64_mask(in_word); /* bit j: all of word j */
    words ^= words << 1;
    words ^= words << 2;
    words ^= words << 4;
    const uint32_t turned = words << 1 ^ (0 - *before); /* bit j: before word j */
    *before ^= words >> (WORDS - 1) & 1;
    const __m512i behind = _mm512_slli_epi64(in_word, 1);
    return _mm512_mask_xor_epi64(behind, (__mmask8)turned, behind, _mm512_set1_epi64(-1));
}

/* Finds the planes of the low bytes before each byte. before[k]: bit k before the first byte; on return after the last.
 *
 * 0xb3 x = t + 16 t + 128 x with t = x + 2 x, all modulo 256: two additions and an exclusive or of the highest bit. */
static inline T3R_AVX512 void find_low(const __m512i byte[PLANES], uint32_t before[PLANES], __m512i low[PLANES])
{
    const __m512i none = _mm512_setzero_si512();
    __m512i x[PLANES], t[PLANES], carry_t = none, carry_u = none;
    T3R_LANES_UNROLL
    for (uint32_t k = 0; k < PLANES; k++) {
        const __m512i doubled = k == 0 ? none : x[k - 1], shifted = k < 4 ? none : t[k - 4];
        __m512i from_below = exclusive_or(doubled, carry_t, _mm512_xor_si512(shifted, carry_u));
        from_below = k == 7 ? _mm512_xor_si512(from_below, x[0]) : from_below;
        low[k] = accumulated(_mm512_xor_si512(byte[k], from_below), &before[k]);
        x[k] = _mm512_xor_si512(low[k], byte[k]);
        t[k] = exclusive_or(x[k], doubled, carry_t);
        carry_t = majority(x[k], doubled, carry_t);
        carry_u = majority(t[k], shifted, carry_u);
    }
}

typedef union planes {
    __m512i vector[PLANES];
    uint64_t word[PLANES][WORDS];
} planes;

static inline T3R_AVX512 void split(const uint8_t *bytes, planes *byte)
{
    for (uint32_t j = 0; j < WORDS; j++) {
        __m512i left = _mm512_loadu_si512(bytes + j * WORD); /* each byte's highest bit is the next plane's */
        T3R_LANES_UNROLL
        for (uint32_t k = PLANES; k-- > 0;) {
            byte->word[k][j] = _mm512_movepi8_mask(left);
            left = _mm512_add_epi8(left, left);
        }
    }
}

static inline T3R_AVX512 __m512i joined(const planes *low, uint32_t j)
{
    __m512i bytes = _mm512_setzero_si512();
    T3R_LANES_UNROLL
    for (uint32_t k = 0; k < PLANES; k++) {
        bytes = _mm512_mask_add_epi8(bytes, low->word[k][j], bytes, _mm512_set1_epi8((char)(1 << k)));
    }
    return bytes;
}

static inline T3R_AVX512 __m512i widened(const uint8_t bytes[GROUP])
{
    return _mm512_cvtepu8_epi64(_mm_loadl_epi64((const __m128i *)(const void *)bytes));
}

/* Continues eight sums over the bytes of a word. */
static inline T3R_AVX512 __m512i add_word(__m512i sums, const uint8_t *bytes, __m512i low_bytes)
{
    uint8_t low[WORD], mixed[WORD];
    _mm512_storeu_si512(low, low_bytes);
    _mm512_storeu_si512(mixed, _mm512_xor_si512(low_bytes, _mm512_loadu_si512(bytes)));
    __m512i of_word = _mm512_setzero_si512();
    T3R_LANES_UNROLL
    for (uint32_t i = 0; i < WORD; i += GROUP) {
        const __m512i difference = _mm512_sub_epi64(widened(mixed + i), widened(low + i));
        of_word = _mm512_add_epi64(of_word, _mm512_mullo_epi64(difference, _mm512_loadu_si512(powers + i)));
    }
    return _mm512_add_epi64(_mm512_mullo_epi64(sums, _mm512_set1_epi64((long long)powers[0])), of_word);
}

/* Sums modulo 2^64: the compiler's own reduction adds signed numbers. */
static inline T3R_AVX512 uint64_t total(__m512i sums)
{
    uint64_t each[GROUP], all = 0;
    _mm512_storeu_si512(each, sums);
    for (uint32_t i = 0; i < GROUP; i++) {
        all += each[i];
    }
    return all;
}

T3R_AVX512 uint64_t t3r_hash_bytes_avx512(uint64_t hash, const uint8_t *bytes, size_t count)
{
    uint32_t before[PLANES];
    for (uint32_t k = 0; k < PLANES; k++) {
        before[k] = (uint32_t)(hash >> k) & 1;
    }
    __m512i sums = _mm512_zextsi128_si512(_mm_cvtsi64_si128((long long)hash));
    size_t done = 0;
    for (; done + WORDS * WORD <= count; done += WORDS * WORD) {
        planes byte, low;
        split(bytes + done, &byte);
        find_low(byte.vector, before, low.vector);
        for (uint32_t j = 0; j < WORDS; j++) {
            sums = add_word(sums, bytes + done + j * WORD, joined(&low, j));
        }
    }
    return t3r_hash_bytes_c(total(sums), bytes + done, count - done);
}

#else
typedef int t3r_no_hash_bytes_avx512; /* a file may not be empty */
#endif
