/* SPDX-License-Identifier: Apache-2.0 */
/* Features of processors as text; trim3r_host.h has those of the current one. */
#ifndef T3R_PLATFORM_CPU_H
#define T3R_PLATFORM_CPU_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r_host.h"

/* Writes the names of the features in a mask, such as "avx2 avx512", cut to fit; "none" for 0. */
void t3r_cpu_describe(uint32_t features, char *text, size_t text_bytes);

/* Parses a mask: "all", "none", names separated by commas ("avx2,vnni"), or a number, decimal or 0x... hexadecimal.
 * Returns false for anything else, with *mask unchanged. */
bool t3r_cpu_parse_mask(const char *text, uint32_t *mask);

#endif
