/* SPDX-License-Identifier: Apache-2.0 */
/* Axes, four splats at a time. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#define AXES t3r_axes_simd128
#include "kernels/lanes/axes_lanes.h"

#else
typedef int t3r_no_axes_simd128; /* a file may not be empty */
#endif
