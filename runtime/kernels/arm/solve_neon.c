/* SPDX-License-Identifier: Apache-2.0 */
/* Corrections, four Gaussians at a time. */
#include "variants.h"

#ifdef T3R_NEON

#include "lanes_neon.h"

#define SOLVE t3r_solve_neon
#include "kernels/lanes/solve_lanes.h"

#else
typedef int t3r_no_solve_neon; /* a file may not be empty */
#endif
