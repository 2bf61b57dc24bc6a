/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/kernels.h"

/* Entries of a feature that is left out are NULL and never called. */
const t3r_kernels t3r_kernels_c = {
    .packed_row = t3r_packed_row_c,
    .nv12_row = t3r_nv12_row_c,
    .triple_row = t3r_triple_row_c,
    .box_sums = t3r_box_sums_c,
    .weigh_row = t3r_weigh_row_c,
    .divide_row = t3r_divide_row_c,
    .unproject = t3r_unproject_c,
    .locate = t3r_locate_c,
#if T3R_FEATURE_STEREO
    .ray_row = t3r_ray_row_c,
    .luma_at = t3r_luma_at_c,
    .census_row = t3r_census_row_c,
    .census_costs = t3r_census_costs_c,
    .path_row = t3r_path_row_c,
    .winner_row = t3r_winner_row_c,
    .disparity_at = t3r_disparity_at_c,
#endif
    .luma_row = t3r_luma_row_c,
    .split_row = t3r_split_row_c,
    .db2_predict = t3r_db2_predict_c,
    .db2_lift = t3r_db2_lift_c,
    .db2_split = t3r_db2_split_c,
    .db2_join = t3r_db2_join_c,
    .subtract_row = t3r_subtract_row_c,
#if T3R_FEATURE_EXTRAS
    .haar_update = t3r_haar_update_c,
    .cdf53_predict = t3r_cdf53_predict_c,
    .cdf53_update = t3r_cdf53_update_c,
#endif
    .texture_finest = t3r_texture_finest_c,
    .texture_coarse = t3r_texture_coarse_c,
    .texture_add = t3r_texture_add_c,
    .texture_spread = t3r_texture_spread_c,
    .sample_potential = t3r_sample_potential_c,
    .sample_approach = t3r_sample_approach_c,
    .nearest_begin = t3r_nearest_begin_c,
    .nearest = t3r_nearest_c,
    .blur_row = t3r_blur_row_c,
    .blur_column = t3r_blur_column_c,
    .wanted_row = t3r_wanted_row_c,
    .key_row = t3r_key_row_c,
#if T3R_FEATURE_LEARNED
    .convolve = t3r_convolve_c,
    .depthwise = t3r_depthwise_c,
#endif
    .project = t3r_project_c,
    .radix_count = t3r_radix_count_c,
    .radix_pass = t3r_radix_pass_c,
    .place = t3r_place_c,
    .blend = t3r_blend_c,
#if T3R_FEATURE_REFINEMENT
    .blend_keep = t3r_blend_keep_c,
    .axes = t3r_axes_c,
    .compare_row = t3r_compare_row_c,
    .scatter = t3r_scatter_c,
    .solve = t3r_solve_c,
#endif
    .hash_bytes = t3r_hash_bytes_c,
    .strip_bytes = 2,
};
