/* SPDX-License-Identifier: Apache-2.0 */
/* Blending, eight pixels at a time. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#include "kernels/lanes/vectors/pixels_of_eight.h"

#define BLEND t3r_blend_simd128
#define BLEND_KEEP t3r_blend_keep_simd128
#include "kernels/lanes/blend_pixels.h"

#else
typedef int t3r_no_blend_simd128; /* a file may not be empty */
#endif
