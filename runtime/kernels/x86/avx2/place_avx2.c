/* SPDX-License-Identifier: Apache-2.0 */
/* Splats in a tile, eight at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_avx2.h"

#define PLACE t3r_place_avx2
#include "kernels/lanes/place_lanes.h"

#else
typedef int t3r_no_place_avx2; /* a file may not be empty */
#endif
