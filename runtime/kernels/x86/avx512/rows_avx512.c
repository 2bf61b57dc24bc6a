/* SPDX-License-Identifier: Apache-2.0 */
/* Plain C's loops compiled for AVX-512 with vectors of 512 bits. Rows of pictures are not included: for data beyond
 * the first cache, vectors of 256 bits are equally fast or faster. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#if defined(__clang__)
#pragma clang attribute push(T3R_AVX512, apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("avx2,avx512f,avx512bw,avx512dq,avx512vl,prefer-vector-width=512")
#endif

#define t3r_sample_potential_c t3r_sample_potential_avx512
#define t3r_sample_approach_c t3r_sample_approach_avx512
#include "kernels/plain/seed.c"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#else
typedef int t3r_no_rows_avx512; /* a file may not be empty */
#endif
