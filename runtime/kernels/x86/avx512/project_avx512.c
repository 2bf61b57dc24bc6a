/* SPDX-License-Identifier: Apache-2.0 */
/* Projection, sixteen Gaussians at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86_OPTIMIZED

#include "lanes_avx512.h"

#define PROJECT t3r_project_avx512
#include "kernels/lanes/project_lanes.h"

#else
typedef int t3r_no_project_avx512; /* a file may not be empty */
#endif
