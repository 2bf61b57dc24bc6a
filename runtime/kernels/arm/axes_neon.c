/* SPDX-License-Identifier: Apache-2.0 */
/* Axes, four splats at a time. */
#include "variants.h"

#ifdef T3R_NEON

#include "lanes_neon.h"

#define AXES t3r_axes_neon
#include "kernels/lanes/axes_lanes.h"

#else
typedef int t3r_no_axes_neon; /* a file may not be empty */
#endif
