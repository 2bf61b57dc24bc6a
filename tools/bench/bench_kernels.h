/* SPDX-License-Identifier: Apache-2.0 */
/* The variants of inner loops in a table of kernels. */
#ifndef TRIM3R_TOOLS_BENCH_KERNELS_H
#define TRIM3R_TOOLS_BENCH_KERNELS_H

#include <stdint.h>

#include <cjson/cJSON.h>

#include "kernels/kernels.h"

#define BENCH_KERNELS_MOST 128

typedef struct bench_kernel {
    const char *entry;
    char set[16]; /* the instruction set of its variant, "c" for plain C */
} bench_kernel;

/* Lists the entries that have variants in this build, in the table's order; returns their number. */
uint32_t bench_kernels_of(const t3r_kernels *kernels, bench_kernel list[BENCH_KERNELS_MOST]);

/* Prints the entries by instruction set, in lines as of wrapped_print(). Entries that are not listed exist only in
 * plain C. */
void bench_kernels_print(const t3r_kernels *kernels, uint32_t indent);
/* Adds an object "kernels" with the set of each entry. */
void bench_kernels_add_json(cJSON *root, const t3r_kernels *kernels);

#endif
