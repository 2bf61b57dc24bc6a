/* SPDX-License-Identifier: Apache-2.0 */
/* Blending, sixteen pixels at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "pixels_avx2.h"

#define BLEND t3r_blend_avx2
#define BLEND_KEEP t3r_blend_keep_avx2
#include "kernels/lanes/blend_pixels.h"

#else
typedef int t3r_no_blend_avx2; /* a file may not be empty */
#endif
