/* SPDX-License-Identifier: Apache-2.0 */
/* Axes, eight splats at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_avx2.h"

#define AXES t3r_axes_avx2
#include "kernels/lanes/axes_lanes.h"

#else
typedef int t3r_no_axes_avx2; /* a file may not be empty */
#endif
