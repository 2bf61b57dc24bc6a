/* Plain C's loops over rows once more, compiled for AVX2: the compiler vectorizes them as well as a hand would. */
#include "variants.h"

#ifdef T3R_X86

#if defined(__clang__)
#pragma clang attribute push(T3R_AVX2, apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

#define t3r_blur_row_c t3r_blur_row_avx2
#define t3r_blur_column_c t3r_blur_column_avx2
#include "kernels/blur.c"

#if T3R_FEATURE_STEREO
#define t3r_census_row_c t3r_census_row_avx2
#include "kernels/census.c"
#endif

#if T3R_FEATURE_LEARNED
#define t3r_convolve_c t3r_convolve_avx2
#define t3r_depthwise_c t3r_depthwise_avx2
#include "kernels/convolve.c"
#endif

#define t3r_packed_row_c t3r_packed_row_avx2
#define t3r_nv12_row_c t3r_nv12_row_avx2
#define t3r_triple_row_c t3r_triple_row_avx2
#define t3r_box_sums_c t3r_box_sums_avx2
#define t3r_weigh_row_c t3r_weigh_row_avx2
#define t3r_divide_row_c t3r_divide_row_avx2
#include "kernels/image_rows.c"

#define t3r_sample_potential_c t3r_sample_potential_avx2
#define t3r_sample_approach_c t3r_sample_approach_avx2
#include "kernels/seed.c"

#define t3r_luma_row_c t3r_luma_row_avx2
#define t3r_split_row_c t3r_split_row_avx2
#define t3r_db2_predict_c t3r_db2_predict_avx2
#define t3r_db2_lift_c t3r_db2_lift_avx2
#define t3r_db2_split_c t3r_db2_split_avx2
#define t3r_db2_join_c t3r_db2_join_avx2
#define t3r_subtract_row_c t3r_subtract_row_avx2
#define t3r_haar_update_c t3r_haar_update_avx2
#define t3r_cdf53_predict_c t3r_cdf53_predict_avx2
#define t3r_cdf53_update_c t3r_cdf53_update_avx2
#define t3r_texture_finest_c t3r_texture_finest_avx2
#define t3r_texture_coarse_c t3r_texture_coarse_avx2
#define t3r_texture_add_c t3r_texture_add_avx2
#define t3r_texture_spread_c t3r_texture_spread_avx2
#include "kernels/wavelet_rows.c"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#else
typedef int t3r_no_rows_avx2; /* a file may not be empty */
#endif
