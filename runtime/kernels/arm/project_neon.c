/* SPDX-License-Identifier: Apache-2.0 */
/* Projection, four Gaussians at a time. */
#include "variants.h"

#ifdef T3R_NEON

#include "lanes_neon.h"

#define PROJECT t3r_project_neon
#include "kernels/lanes/project_lanes.h"

#else
typedef int t3r_no_project_neon; /* a file may not be empty */
#endif
