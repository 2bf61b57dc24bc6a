/* SPDX-License-Identifier: Apache-2.0 */
/* Projection, four Gaussians at a time. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#define PROJECT t3r_project_simd128
#include "kernels/lanes/project_lanes.h"

#else
typedef int t3r_no_project_simd128; /* a file may not be empty */
#endif
