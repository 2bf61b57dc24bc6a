/* SPDX-License-Identifier: Apache-2.0 */
/* A packed layer, eight outputs a vector. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_avx2.h"

#include "kernels/lanes/pairs_of_taps.h"

#define PACK_LAYER t3r_pack_layer_avx2
#define CONVOLVE_PACKED t3r_convolve_packed_avx2
#include "kernels/lanes/convolve_packed_lanes.h"

#else
typedef int t3r_no_convolve_packed_avx2; /* a file may not be empty */
#endif
