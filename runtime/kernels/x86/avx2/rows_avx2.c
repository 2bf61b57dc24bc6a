/* SPDX-License-Identifier: Apache-2.0 */
/* Plain C's loops over rows, compiled for AVX2. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#if defined(__clang__)
#pragma clang attribute push(T3R_AVX2, apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2")
#endif

#define ROW(name) t3r_##name##_avx2
#define t3r_blur_row_c ROW(blur_row)
#define t3r_blur_column_c ROW(blur_column)
#include "kernels/plain/blur.c"

#if T3R_FEATURE_STEREO
#define t3r_census_row_c ROW(census_row)
#include "kernels/plain/census.c"
#endif

#if T3R_FEATURE_LEARNED
#define t3r_convolve_c ROW(convolve)
#define t3r_depthwise_c ROW(depthwise)
#include "kernels/plain/convolve.c"
#endif

#include "kernels/lanes/rows.h"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#else
typedef int t3r_no_rows_avx2; /* a file may not be empty */
#endif
