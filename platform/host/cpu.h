/* What the processor at hand has, for t3r_set_cpu(): features that its operating system supports as well. */
#ifndef T3R_PLATFORM_CPU_H
#define T3R_PLATFORM_CPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* T3R_CPU_... bits; 0 on a processor of which nothing is known. */
uint32_t t3r_cpu_features(void);

/* The features of a mask by name, as "avx2 avx512", cut to fit; "none" for 0. */
void t3r_cpu_describe(uint32_t features, char *text, size_t text_bytes);

/* A mask as text: "all", "none", names with commas between ("avx2,vnni"), or a number, decimal or 0x... in hexadecimal.
 * False: it is none of these, and *mask stays as it is. */
bool t3r_cpu_parse_mask(const char *text, uint32_t *mask);

#endif
