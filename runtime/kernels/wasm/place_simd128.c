/* SPDX-License-Identifier: Apache-2.0 */
/* Splats in a tile, four at a time. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#define PLACE t3r_place_simd128
#include "kernels/lanes/place_lanes.h"

#else
typedef int t3r_no_place_simd128; /* a file may not be empty */
#endif
