/* SPDX-License-Identifier: Apache-2.0 */
/* Masks of processor features as text. */
#include "host/cpu.h"
#include "trim3r.h"
#include "unit/unit.h"

/* Returns what the compiler's own library finds. */
static uint32_t found_by_the_compiler(void)
{
#if defined(__x86_64__)
    const bool has_avx512 = __builtin_cpu_supports("avx512f") && __builtin_cpu_supports("avx512bw") &&
                            __builtin_cpu_supports("avx512cd") && __builtin_cpu_supports("avx512dq") &&
                            __builtin_cpu_supports("avx512vl");
    return (__builtin_cpu_supports("sse4.1") ? T3R_CPU_SSE41 : 0) |
           (__builtin_cpu_supports("avx2") ? T3R_CPU_AVX2 : 0) | (has_avx512 ? T3R_CPU_AVX512 : 0) |
           (__builtin_cpu_supports("avx512vnni") ? T3R_CPU_VNNI : 0);
#elif defined(__aarch64__)
    return T3R_CPU_NEON | (t3r_cpu_features() & T3R_CPU_DOTPROD);
#else
    return 0;
#endif
}

TEST(features_are_found)
{
    assert_int_equal(t3r_cpu_features(), found_by_the_compiler());
    assert_int_equal(t3r_cpu_found() & ~t3r_cpu_features(), 0);
    assert_int_equal(t3r_cpu_features() & ~t3r_cpu_found() & ~T3R_CPU_DOTPROD, 0);
}

TEST(masks_are_read)
{
    static const struct {
        const char *text;
        uint32_t mask;
    } good[] = {{"all", UINT32_MAX},
                {"none", 0},
                {"0", 0},
                {"255", 255},
                {"0x10", 16},
                {"4294967295", UINT32_MAX},
                {"sse4.1", T3R_CPU_SSE41},
                {"avx2", T3R_CPU_AVX2},
                {"vnni,avx2", T3R_CPU_VNNI | T3R_CPU_AVX2},
                {"neon,dotprod,mve,dsp,simd128,avx512",
                 T3R_CPU_NEON | T3R_CPU_DOTPROD | T3R_CPU_MVE | T3R_CPU_DSP | T3R_CPU_SIMD128 | T3R_CPU_AVX512}};
    for (size_t i = 0; i < sizeof good / sizeof good[0]; i++) {
        uint32_t mask = 12345;
        assert_true(t3r_cpu_parse_mask(good[i].text, &mask));
        assert_int_equal(mask, good[i].mask);
    }
    static const char *const bad[] = {"", "avx", "avx2,", ",avx2", "avx2 vnni", "0x", "-1", "4294967296", "1x", "ALL"};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        uint32_t mask = 12345;
        assert_false(t3r_cpu_parse_mask(bad[i], &mask));
        assert_int_equal(mask, 12345);
    }
}

TEST(features_are_named)
{
    char text[64];
    t3r_cpu_describe(0, text, sizeof text);
    assert_string_equal(text, "none");
    t3r_cpu_describe(T3R_CPU_AVX2 | T3R_CPU_VNNI, text, sizeof text);
    assert_string_equal(text, "avx2 vnni");
    t3r_cpu_describe(UINT32_MAX, text, 6); /* truncated */
    assert_string_equal(text, "sse4.");
    t3r_cpu_describe(t3r_cpu_features(), text, sizeof text);
    for (char *c = text; *c != '\0'; c++) {
        *c = *c == ' ' ? ',' : *c;
    }
    uint32_t mask;
    assert_true(t3r_cpu_parse_mask(text, &mask));
    assert_int_equal(mask, t3r_cpu_features());
}
