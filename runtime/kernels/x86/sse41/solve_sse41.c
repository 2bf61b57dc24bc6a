/* SPDX-License-Identifier: Apache-2.0 */
/* Corrections, four Gaussians at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_sse41.h"

#define SOLVE t3r_solve_sse41
#include "kernels/lanes/solve_lanes.h"

#else
typedef int t3r_no_solve_sse41; /* a file may not be empty */
#endif
