/* SPDX-License-Identifier: Apache-2.0 */
/* Blending, eight pixels at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_sse41.h"

#include "kernels/lanes/vectors/pixels_of_eight.h"

#define BLEND t3r_blend_sse41
#define BLEND_KEEP t3r_blend_keep_sse41
#include "kernels/lanes/blend_pixels.h"

#else
typedef int t3r_no_blend_sse41; /* a file may not be empty */
#endif
