/* SPDX-License-Identifier: Apache-2.0 */
/* Axes, four splats at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_sse41.h"

#define AXES t3r_axes_sse41
#include "kernels/lanes/axes_lanes.h"

#else
typedef int t3r_no_axes_sse41; /* a file may not be empty */
#endif
