/* SPDX-License-Identifier: Apache-2.0 */
/* Scattering, sixteen pixels at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "pixels_avx2.h"

#define SCATTER t3r_scatter_avx2
#define T3R_SCATTER T3R_AVX2
#define SCATTER_ADD(sum, a, b) add(sum, OF_LANES(madd_epi16)(a, b))
#include "kernels/lanes/scatter_pixels.h"

#else
typedef int t3r_no_scatter_avx2; /* a file may not be empty */
#endif
