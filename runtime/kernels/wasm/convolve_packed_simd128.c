/* SPDX-License-Identifier: Apache-2.0 */
/* A packed layer, four outputs a vector. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#include "kernels/lanes/pairs_of_taps.h"

#define PACK_LAYER t3r_pack_layer_simd128
#define CONVOLVE_PACKED t3r_convolve_packed_simd128
#include "kernels/lanes/convolve_packed_lanes.h"

#else
typedef int t3r_no_convolve_packed_simd128; /* a file may not be empty */
#endif
