/* SPDX-License-Identifier: Apache-2.0 */
/* Corrections, eight Gaussians at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_avx2.h"

#define SOLVE t3r_solve_avx2
#include "kernels/lanes/solve_lanes.h"

#else
typedef int t3r_no_solve_avx2; /* a file may not be empty */
#endif
