/* SPDX-License-Identifier: Apache-2.0 */
#include "cpu.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "trim3r.h"

#if defined(__aarch64__) && defined(__linux__)
#include <asm/hwcap.h>
#include <sys/auxv.h>
#endif

static const struct {
    const char *name;
    uint32_t bit;
} features[] = {
    {"sse4.1", T3R_CPU_SSE41}, {"avx2", T3R_CPU_AVX2}, {"avx512", T3R_CPU_AVX512},
    {"vnni", T3R_CPU_VNNI},    {"neon", T3R_CPU_NEON}, {"dotprod", T3R_CPU_DOTPROD},
    {"mve", T3R_CPU_MVE},      {"dsp", T3R_CPU_DSP},   {"simd128", T3R_CPU_SIMD128},
};
enum { FEATURES = sizeof features / sizeof features[0] };

uint32_t t3r_cpu_features(void)
{
    uint32_t found = t3r_cpu_found();
#if defined(__aarch64__) && defined(__linux__)
    found |= (getauxval(AT_HWCAP) & HWCAP_ASIMDDP) != 0 ? T3R_CPU_DOTPROD : 0;
#endif
    return found;
}

void t3r_cpu_describe(uint32_t mask, char *text, size_t text_bytes)
{
    size_t length = 0;
    snprintf(text, text_bytes, "none");
    for (int i = 0; i < FEATURES; i++) {
        if ((mask & features[i].bit) != 0 && length < text_bytes) {
            int wrote = snprintf(text + length, text_bytes - length, "%s%s", length == 0 ? "" : " ", features[i].name);
            length += (size_t)wrote;
        }
    }
}

static bool parse_number(const char *text, uint32_t *mask)
{
    const bool is_hexadecimal = text[0] == '0' && (text[1] == 'x' || text[1] == 'X');
    const char *digits = is_hexadecimal ? text + 2 : text;
    size_t length = strspn(digits, is_hexadecimal ? "0123456789abcdefABCDEF" : "0123456789");
    errno = 0;
    unsigned long long number = strtoull(digits, NULL, is_hexadecimal ? 16 : 10);
    if (length == 0 || digits[length] != '\0' || errno != 0 || number > UINT32_MAX) {
        return false;
    }
    *mask = (uint32_t)number;
    return true;
}

/* Returns the bit of a name of `length` characters; 0 for an unknown name. */
static uint32_t bit_of(const char *name, size_t length)
{
    for (int i = 0; i < FEATURES; i++) {
        if (strlen(features[i].name) == length && strncmp(features[i].name, name, length) == 0) {
            return features[i].bit;
        }
    }
    return 0;
}

bool t3r_cpu_parse_mask(const char *text, uint32_t *mask)
{
    if (strcmp(text, "all") == 0) {
        *mask = UINT32_MAX;
        return true;
    }
    if (strcmp(text, "none") == 0) {
        *mask = 0;
        return true;
    }
    if (parse_number(text, mask)) {
        return true;
    }
    uint32_t named = 0;
    for (const char *at = text;; at++) {
        size_t length = strcspn(at, ",");
        uint32_t bit = bit_of(at, length);
        if (bit == 0) {
            return false;
        }
        named |= bit;
        at += length;
        if (*at == '\0') {
            *mask = named;
            return true;
        }
    }
}
