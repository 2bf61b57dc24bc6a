/* SPDX-License-Identifier: Apache-2.0 */
/* Scattering, sixteen pixels at a time, by AVX-512's sums of products. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "kernels/x86/avx2/pixels_avx2.h"

#define SCATTER t3r_scatter_vnni
#define T3R_SCATTER T3R_VNNI
#define SCATTER_ADD(sum, a, b) _mm256_dpwssd_epi32(sum, a, b)
#include "kernels/lanes/scatter_pixels.h"

#else
typedef int t3r_no_scatter_vnni; /* a file may not be empty */
#endif
