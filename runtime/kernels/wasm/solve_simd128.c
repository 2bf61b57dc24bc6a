/* SPDX-License-Identifier: Apache-2.0 */
/* Corrections, four Gaussians at a time. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#define SOLVE t3r_solve_simd128
#include "kernels/lanes/solve_lanes.h"

#else
typedef int t3r_no_solve_simd128; /* a file may not be empty */
#endif
