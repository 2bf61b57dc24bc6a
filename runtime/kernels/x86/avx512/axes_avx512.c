/* SPDX-License-Identifier: Apache-2.0 */
/* Axes, sixteen splats at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86_OPTIMIZED

#include "lanes_avx512.h"

#define AXES t3r_axes_avx512
#include "kernels/lanes/axes_lanes.h"

#else
typedef int t3r_no_axes_avx512; /* a file may not be empty */
#endif
