/* SPDX-License-Identifier: Apache-2.0 */
#include "checks.h"

#include "kernels/variants.h"

/* X(entry, check) */
#define ENTRIES(X)                                                                                                     \
    X(packed_row, check_packed_row)                                                                                    \
    X(nv12_row, check_nv12_row)                                                                                        \
    X(triple_row, check_triple_row)                                                                                    \
    X(box_sums, check_box_sums)                                                                                        \
    X(weigh_row, check_weigh_row)                                                                                      \
    X(divide_row, check_divide_row)                                                                                    \
    X(unproject, check_unproject)                                                                                      \
    X(locate, check_locate)                                                                                            \
    X(ray_row, check_ray_row)                                                                                          \
    X(disparity_at, check_disparity_at)                                                                                \
    X(luma_at, check_luma_at)                                                                                          \
    X(census_row, check_census_row)                                                                                    \
    X(census_costs, check_census_costs)                                                                                \
    X(path_row, check_path_row)                                                                                        \
    X(winner_row, check_winner_row)                                                                                    \
    X(luma_row, check_luma_row)                                                                                        \
    X(split_row, check_split_row)                                                                                      \
    X(db2_predict, check_db2_predict)                                                                                  \
    X(db2_lift, check_db2_lift)                                                                                        \
    X(db2_split, check_db2_split)                                                                                      \
    X(db2_join, check_db2_join)                                                                                        \
    X(subtract_row, check_subtract_row)                                                                                \
    X(haar_update, check_haar_update)                                                                                  \
    X(cdf53_predict, check_cdf53_predict)                                                                              \
    X(cdf53_update, check_cdf53_update)                                                                                \
    X(texture_finest, check_texture_finest)                                                                            \
    X(texture_coarse, check_texture_coarse)                                                                            \
    X(texture_add, check_texture_add)                                                                                  \
    X(texture_spread, check_texture_spread)                                                                            \
    X(sample_potential, check_sample_potential)                                                                        \
    X(sample_approach, check_sample_approach)                                                                          \
    X(nearest_begin, check_nearest)                                                                                    \
    X(nearest, check_nearest)                                                                                          \
    X(blur_row, check_blur_row)                                                                                        \
    X(blur_column, check_blur_column)                                                                                  \
    X(wanted_row, check_wanted_row)                                                                                    \
    X(key_row, check_key_row)                                                                                          \
    X(convolve, check_convolve)                                                                                        \
    X(depthwise, check_depthwise)                                                                                      \
    X(pack_layer, check_convolve_packed)                                                                               \
    X(convolve_packed, check_convolve_packed)                                                                          \
    X(project, check_project)                                                                                          \
    X(radix_count, check_radix_count)                                                                                  \
    X(radix_pass, check_radix_pass)                                                                                    \
    X(place, check_place)                                                                                              \
    X(blend, check_blend)                                                                                              \
    X(blend_keep, check_blend_keep)                                                                                    \
    X(axes, check_axes)                                                                                                \
    X(compare_row, check_compare_row)                                                                                  \
    X(scatter, check_scatter)                                                                                          \
    X(solve, check_solve)                                                                                              \
    X(hash_bytes, check_hash_bytes)

const checked_entry checked_entries[] = {
#define ENTRY(entry, check) {#entry, check},
    ENTRIES(ENTRY)};
const size_t checked_entries_count = sizeof checked_entries / sizeof checked_entries[0];

typedef void any_function(void);

_Static_assert(offsetof(t3r_kernels, strip_bytes) ==
                   sizeof checked_entries / sizeof checked_entries[0] * sizeof(any_function *),
               "no entry is left out");

const checked_variant checked_variants[] = {
#define VARIANT(entry, features, function) {#entry, features},
    T3R_VARIANTS(VARIANT){NULL, 0}};

const checked_entry *checked_entry_named(const char *name)
{
    for (size_t i = 0; i < checked_entries_count; i++) {
        if (strcmp(checked_entries[i].name, name) == 0) {
            return &checked_entries[i];
        }
    }
    return NULL;
}
