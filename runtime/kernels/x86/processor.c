/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/x86/processor.h"

#include "trim3r.h"

#if defined(__x86_64__)
#include <cpuid.h>

/* Bits of XCR0: the registers that the operating system saves. */
#define SAVED_YMM 0x06u
#define SAVED_ZMM 0xe6u

/* Returns the low half of XCR0. The processor must have OSXSAVE. */
static uint32_t saved_registers(void)
{
    uint32_t low, high;
    __asm__ volatile("xgetbv" : "=a"(low), "=d"(high) : "c"(0));
    return low;
}

static uint32_t feature_if(uint32_t feature, uint32_t word, uint32_t bits)
{
    return (word & bits) == bits ? feature : 0;
}

uint32_t t3r_x86_features(void)
{
    const uint32_t parts_of_avx512 = bit_AVX512F | bit_AVX512BW | bit_AVX512CD | bit_AVX512DQ | bit_AVX512VL;
    uint32_t a = 0, b = 0, c = 0, d = 0;
    (void)__get_cpuid(1, &a, &b, &c, &d);
    const uint32_t saved = (c & bit_OSXSAVE) != 0 ? saved_registers() : 0;
    const uint32_t narrow = feature_if(T3R_CPU_SSE41, c, bit_SSE4_1);
    b = c = 0; /* an old processor does not answer the next question */
    (void)__get_cpuid_count(7, 0, &a, &b, &c, &d);
    const uint32_t wide = feature_if(T3R_CPU_AVX2, b, bit_AVX2);
    const uint32_t widest = feature_if(T3R_CPU_AVX512, b, parts_of_avx512);
    const uint32_t products = feature_if(T3R_CPU_VNNI, c, bit_AVX512VNNI);
    return narrow | feature_if(wide, saved, SAVED_YMM) | feature_if(widest | products, saved, SAVED_ZMM);
}
#endif
