/* SPDX-License-Identifier: Apache-2.0 */
/* Projection, four Gaussians at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_sse41.h"

#define PROJECT t3r_project_sse41
#include "kernels/lanes/project_lanes.h"

#else
typedef int t3r_no_project_sse41; /* a file may not be empty */
#endif
