/* SPDX-License-Identifier: Apache-2.0 */
/* A check for each entry of the table of kernels. It makes a random or extreme input from the seed, runs the entry in
 * guarded buffers and compares with a straightforward reference, or with plain C where a test in doubles checks plain
 * C. */
#ifndef T3R_TESTS_KERNEL_CHECKS_H
#define T3R_TESTS_KERNEL_CHECKS_H

#include <math.h>
#include <stddef.h>
#include <stdlib.h>
#include <string.h>

#include "kernels/kernels.h"
#include "unit/noise.h"

/* Returns the error as text; NULL: none. */
typedef const char *kernel_check(const t3r_kernels *kernels, uint64_t *seed);

kernel_check check_packed_row, check_nv12_row, check_triple_row, check_box_sums, check_weigh_row, check_divide_row;
kernel_check check_unproject, check_locate;
kernel_check check_ray_row, check_luma_at, check_disparity_at;
kernel_check check_census_row, check_census_costs, check_path_row, check_winner_row;
kernel_check check_luma_row, check_split_row, check_db2_predict, check_db2_lift, check_db2_split, check_db2_join;
kernel_check check_subtract_row;
kernel_check check_haar_update, check_cdf53_predict, check_cdf53_update;
kernel_check check_texture_finest, check_texture_coarse, check_texture_add, check_texture_spread;
kernel_check check_sample_potential, check_sample_approach, check_nearest;
kernel_check check_blur_row, check_blur_column, check_wanted_row, check_key_row;
kernel_check check_convolve, check_depthwise, check_convolve_packed;
kernel_check check_project, check_radix_count, check_radix_pass;
kernel_check check_place, check_blend, check_blend_keep, check_axes;
kernel_check check_compare_row, check_scatter, check_solve;
kernel_check check_hash_bytes;

/* The table's entries. */
typedef struct checked_entry {
    const char *name;
    kernel_check *check;
} checked_entry;
extern const checked_entry checked_entries[];
extern const size_t checked_entries_count;
const checked_entry *checked_entry_named(const char *name);

/* All variants of this build, followed by NULL. A table chosen by exactly these features contains the variant. */
typedef struct checked_variant {
    const char *entry;
    uint32_t features;
} checked_variant;
extern const checked_variant checked_variants[];

/* Returns 0, 1 or a small length often, else up to `most`. */
static inline uint32_t any_length(uint64_t *seed, uint32_t most)
{
    const uint32_t small = most < 40 ? most : 40;
    return (uint32_t)unit_between(seed, 0, unit_random(seed) % 2 ? small : most);
}

/* Returns a number in low..high, often an end. */
static inline int64_t any_value(uint64_t *seed, int64_t low, int64_t high)
{
    switch (unit_random(seed) % 8) {
    case 0:
        return low;
    case 1:
        return high;
    default:
        return unit_between(seed, low, high);
    }
}

#define SAME(a, b, count) (memcmp(a, b, (count) * sizeof *(a)) == 0)

#endif
