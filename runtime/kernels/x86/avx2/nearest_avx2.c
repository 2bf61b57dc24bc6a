/* SPDX-License-Identifier: Apache-2.0 */
/* The nearest centre, eight at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_avx2.h"

#define NEAREST_BEGIN t3r_nearest_begin_avx2
#define NEAREST t3r_nearest_avx2
#include "kernels/lanes/nearest_lanes.h"

#else
typedef int t3r_no_nearest_avx2; /* a file may not be empty */
#endif
