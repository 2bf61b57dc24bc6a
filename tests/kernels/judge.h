/* SPDX-License-Identifier: Apache-2.0 */
/* Compares entries of a table of kernels with their references, seed by seed. */
#ifndef T3R_TESTS_KERNEL_JUDGE_H
#define T3R_TESTS_KERNEL_JUDGE_H

#include <stdbool.h>

#include "checks.h"

/* Consecutive seeds. */
typedef struct judged_seeds {
    uint64_t first, rounds;
} judged_seeds;

/* Returns the entry's error at a seed; NULL: none. */
const char *judge_at(const t3r_kernels *kernels, const checked_entry *entry, uint64_t seed);

/* Returns the first error and its seed; NULL: none in all rounds. */
const char *judge(const t3r_kernels *kernels, const checked_entry *entry, judged_seeds seeds, uint64_t *seed);

/* Runs judge() for each variant whose features the processor has, with exactly these features. Writes errors to
 * stderr; *tested: the number of variants. */
bool judge_variants(uint32_t processor, judged_seeds seeds, uint32_t *tested);

/* Runs judge() for one entry; errors name the features that the table was chosen for. */
bool judge_named(const t3r_kernels *kernels, const checked_entry *entry, judged_seeds seeds, const char *name);

/* Wrong entries: each must be found. */
typedef struct wrong_variant {
    const char *entry;
    t3r_kernels kernels;
} wrong_variant;
enum { WRONG_VARIANTS = 6 };
void make_wrong_variants(wrong_variant variants[WRONG_VARIANTS]);

#endif
