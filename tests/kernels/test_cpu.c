/* SPDX-License-Identifier: Apache-2.0 */
/* Masks of processor features as text. */
#include "host/cpu.h"
#include "trim3r.h"
#include "unit/unit.h"

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
