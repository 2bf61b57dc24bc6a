#include "bench/bench_limits.h"

#include <string.h>

#include "trim3r.h"

#if defined(__x86_64__)
#include <immintrin.h>
#elif defined(__aarch64__)
#include <arm_neon.h>
#endif

/* Independent sums: an instruction's latency in cycles times the number that start per cycle. */
#define SUMS 12

static volatile int32_t sink;

/* `opaque` does nothing, but makes the compiler assume another value each time. */
#define ROUNDS(lanes) ((uint32_t)(BENCH_MULTIPLY_ADDS / ((lanes)*SUMS)))
#define LOOP(lanes, opaque, step)                                                                                      \
    for (uint32_t round = 0; round < ROUNDS(lanes); round++) {                                                         \
        _Pragma("GCC unroll 12") for (int s = 0; s < SUMS; s++)                                                        \
        {                                                                                                              \
            opaque;                                                                                                    \
            sums[s] = step;                                                                                            \
        }                                                                                                              \
    }

#if defined(__x86_64__)

__attribute__((target("avx512f,avx512bw,avx512vl,avx512vnni"))) static double multiply_vnni(void)
{
    __m512i sums[SUMS], a = _mm512_set1_epi8(3), all = _mm512_setzero_si512();
    const __m512i b = _mm512_set1_epi8(5);
    for (int s = 0; s < SUMS; s++) {
        sums[s] = _mm512_set1_epi32(s);
    }
    LOOP(64, __asm__("" : "+v"(a)), _mm512_dpbusd_epi32(sums[s], a, b))
    for (int s = 0; s < SUMS; s++) {
        all = _mm512_add_epi32(all, sums[s]);
    }
    sink = _mm512_reduce_add_epi32(all);
    return 64.0 * SUMS * ROUNDS(64);
}

__attribute__((target("avx2"))) static double multiply_avx2(void)
{
    __m256i sums[SUMS], a = _mm256_set1_epi8(3), all = _mm256_setzero_si256();
    const __m256i b = _mm256_set1_epi8(5), ones = _mm256_set1_epi16(1);
    for (int s = 0; s < SUMS; s++) {
        sums[s] = _mm256_set1_epi32(s);
    }
    LOOP(32, __asm__("" : "+x"(a)), _mm256_add_epi32(sums[s], _mm256_madd_epi16(_mm256_maddubs_epi16(a, b), ones)))
    for (int s = 0; s < SUMS; s++) {
        all = _mm256_add_epi32(all, sums[s]);
    }
    sink = _mm256_extract_epi32(all, 0);
    return 32.0 * SUMS * ROUNDS(32);
}

/* Uses SSE2, which multiplies 16-bit numbers. */
static double multiply_plain(void)
{
    __m128i sums[SUMS], a = _mm_set1_epi16(3), all = _mm_setzero_si128();
    const __m128i b = _mm_set1_epi16(5);
    for (int s = 0; s < SUMS; s++) {
        sums[s] = _mm_set1_epi32(s);
    }
    LOOP(8, __asm__("" : "+x"(a)), _mm_add_epi32(sums[s], _mm_madd_epi16(a, b)))
    for (int s = 0; s < SUMS; s++) {
        all = _mm_add_epi32(all, sums[s]);
    }
    sink = _mm_cvtsi128_si32(all);
    return 8.0 * SUMS * ROUNDS(8);
}

double bench_multiply_adds(uint32_t cpu)
{
    return (cpu & T3R_CPU_VNNI) != 0 ? multiply_vnni() : (cpu & T3R_CPU_AVX2) != 0 ? multiply_avx2() : multiply_plain();
}

#elif defined(__aarch64__)

__attribute__((target("+dotprod"))) static double multiply_dotprod(void)
{
    int32x4_t sums[SUMS], all = vdupq_n_s32(0);
    int8x16_t a = vdupq_n_s8(3);
    const int8x16_t b = vdupq_n_s8(5);
    for (int s = 0; s < SUMS; s++) {
        sums[s] = vdupq_n_s32(s);
    }
    LOOP(16, __asm__("" : "+w"(a)), vdotq_s32(sums[s], a, b))
    for (int s = 0; s < SUMS; s++) {
        all = vaddq_s32(all, sums[s]);
    }
    sink = vaddvq_s32(all);
    return 16.0 * SUMS * ROUNDS(16);
}

static double multiply_neon(void)
{
    int32x4_t sums[SUMS], all = vdupq_n_s32(0);
    int8x8_t a = vdup_n_s8(3);
    const int8x8_t b = vdup_n_s8(5);
    for (int s = 0; s < SUMS; s++) {
        sums[s] = vdupq_n_s32(s);
    }
    LOOP(8, __asm__("" : "+w"(a)), vpadalq_s16(sums[s], vmull_s8(a, b)))
    for (int s = 0; s < SUMS; s++) {
        all = vaddq_s32(all, sums[s]);
    }
    sink = vaddvq_s32(all);
    return 8.0 * SUMS * ROUNDS(8);
}

double bench_multiply_adds(uint32_t cpu)
{
    return (cpu & T3R_CPU_DOTPROD) != 0 ? multiply_dotprod() : multiply_neon();
}

#else

/* Leaves vectorization to the compiler. */
double bench_multiply_adds(uint32_t cpu)
{
    enum { LENGTH = 256 };
    static int8_t a[LENGTH], b[LENGTH];
    const uint32_t rounds = (uint32_t)(BENCH_MULTIPLY_ADDS / 4 / LENGTH);
    int32_t sum = 0;
    (void)cpu;
    for (uint32_t round = 0; round < rounds; round++) {
        a[round % LENGTH] = (int8_t)round;
        for (int i = 0; i < LENGTH; i++) {
            sum += a[i] * b[i];
        }
    }
    sink = sum;
    return (double)LENGTH * rounds;
}

#endif

void bench_copy(uint8_t *restrict to, const uint8_t *restrict from)
{
    memcpy(to, from, BENCH_COPY_BYTES);
    sink = to[BENCH_COPY_BYTES - 1];
}
