/* SPDX-License-Identifier: Apache-2.0 */
/* The nearest centre, four at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_sse41.h"

#define NEAREST_BEGIN t3r_nearest_begin_sse41
#define NEAREST t3r_nearest_sse41
#include "kernels/lanes/nearest_lanes.h"

#else
typedef int t3r_no_nearest_sse41; /* a file may not be empty */
#endif
