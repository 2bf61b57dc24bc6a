/* SPDX-License-Identifier: Apache-2.0 */
/* Scattering, eight pixels at a time. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#include "kernels/lanes/vectors/pixels_of_eight.h"

#define SCATTER t3r_scatter_simd128
#define T3R_SCATTER T3R_LANES_TARGET
#define SCATTER_ADD(sum, a, b) add(sum, OF_LANES(madd_epi16)(a, b))
#include "kernels/lanes/scatter_pixels.h"

#else
typedef int t3r_no_scatter_simd128; /* a file may not be empty */
#endif
