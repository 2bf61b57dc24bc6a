/* SPDX-License-Identifier: Apache-2.0 */
/* The nearest centre, four at a time. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#define NEAREST_BEGIN t3r_nearest_begin_simd128
#define NEAREST t3r_nearest_simd128
#include "kernels/lanes/nearest_lanes.h"

#else
typedef int t3r_no_nearest_simd128; /* a file may not be empty */
#endif
