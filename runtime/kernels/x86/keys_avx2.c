/* Eight keys at a time: keys.c step by step, the table of logarithms by gathers. */
#include "variants.h"

#ifdef T3R_X86

#include "core/logarithm.h"
#include "intrinsics.h"

#define LANES 8u

typedef uint32_t lanes __attribute__((vector_size(LANES * sizeof(uint32_t))));

static inline T3R_AVX2 lanes all(uint32_t x)
{
    return (lanes){0} + x;
}

static inline T3R_AVX2 lanes widened(const uint16_t *from)
{
    return (lanes)_mm256_cvtepu16_epi32(_mm_loadu_si128((const __m128i *)(const void *)from));
}

/* x below 2^16 */
static inline T3R_AVX2 void narrow(lanes x, uint16_t *to)
{
    const __m256i packed = _mm256_permute4x64_epi64(_mm256_packus_epi32((__m256i)x, (__m256i)x), 0x08);
    _mm_storeu_si128((__m128i *)(void *)to, _mm256_castsi256_si128(packed));
}

static inline T3R_AVX2 lanes looked_up(const uint32_t *table, lanes index)
{
    return (lanes)_mm256_i32gather_epi32((const int *)(const void *)table, (__m256i)index, 4);
}

/* t3r_log2_inline_q16() of 1 <= x < 2^31 */
static inline T3R_AVX2 lanes log2_q16(lanes x)
{
    lanes shift = all(0);
    for (uint32_t step = 16; step > 0; step >>= 1) {
        shift += (lanes)((x << shift) < all(1u << (32 - step))) & step;
    }
    const lanes mantissa = x << shift, index = (mantissa >> 24) & 127;
    const lanes low = looked_up(t3r_log2_table_q20, index), high = looked_up(t3r_log2_table_q20 + 1, index);
    const lanes log_q20 = low + (((high - low) * ((mantissa >> 8) & 0xffff) + 0x8000) >> 16);
    return ((31 - shift) << 16) + ((log_q20 + 8) >> 4);
}

T3R_AVX2 void t3r_wanted_row_avx2(const uint16_t *restrict texture_q4, uint32_t count, uint32_t gamma_q8,
                                  uint16_t *restrict wanted_q10)
{
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        const lanes log_q16 = log2_q16(widened(texture_q4 + i) + T3R_TEXTURE_FLOOR_Q4);
        narrow((log_q16 * gamma_q8 + (1u << 13)) >> 14, wanted_q10 + i);
    }
    t3r_wanted_row_c(texture_q4 + i, count - i, gamma_q8, wanted_q10 + i);
}

/* t3r_mix32() */
static inline T3R_AVX2 lanes mixed(lanes x)
{
    x ^= x >> 16;
    x *= 0x7feb352du;
    x ^= x >> 15;
    x *= 0x846ca68bu;
    return x ^ (x >> 16);
}

T3R_AVX2 void t3r_key_row_avx2(uint32_t place, uint32_t seed, const uint16_t *rank, const uint16_t *restrict wanted_q10,
                               uint32_t count, uint16_t *restrict key)
{
    const lanes number = {0, 1, 2, 3, 4, 5, 6, 7};
    uint32_t i = 0;
    for (; i + LANES <= count; i += LANES) {
        const lanes noise = mixed(((place ^ i) ^ number) ^ seed);
        const lanes threshold = rank != NULL ? widened(rank + i) * 16 + (noise >> 28) : noise >> 16;
        const lanes log_q10 = ((log2_q16(2 * threshold + 1) + 32) >> 6) + (uint32_t)(T3R_KEY_ZERO - (17 << 10));
        const __m256i relative =
            _mm256_min_epi32(_mm256_max_epi32((__m256i)(log_q10 - widened(wanted_q10 + i)), _mm256_set1_epi32(16)),
                             _mm256_set1_epi32(UINT16_MAX));
        const lanes is_sure = (lanes)(threshold < all(T3R_SURE_THRESHOLD));
        narrow((is_sure & (threshold >> 4)) | (~is_sure & (lanes)relative), key + i);
    }
    t3r_key_row_c(place ^ i, seed, rank != NULL ? rank + i : NULL, wanted_q10 + i, count - i, key + i);
}

#else
typedef int t3r_no_keys_avx2; /* a file may not be empty */
#endif
