/* SPDX-License-Identifier: Apache-2.0 */
/* Splats in a tile, four at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_sse41.h"

#define PLACE t3r_place_sse41
#include "kernels/lanes/place_lanes.h"

#else
typedef int t3r_no_place_sse41; /* a file may not be empty */
#endif
