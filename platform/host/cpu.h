/* Features of the current processor that its operating system supports as well, for t3r_set_cpu(). */
#ifndef T3R_PLATFORM_CPU_H
#define T3R_PLATFORM_CPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Returns T3R_CPU_... bits; 0 on an unknown processor. */
uint32_t t3r_cpu_features(void);

/* Writes the names of the features in a mask, such as "avx2 avx512", cut to fit; "none" for 0. */
void t3r_cpu_describe(uint32_t features, char *text, size_t text_bytes);

/* Parses a mask: "all", "none", names separated by commas ("avx2,vnni"), or a number, decimal or 0x... hexadecimal.
 * Returns false for anything else, with *mask unchanged. */
bool t3r_cpu_parse_mask(const char *text, uint32_t *mask);

#endif
