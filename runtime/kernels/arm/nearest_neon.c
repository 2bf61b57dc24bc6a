/* SPDX-License-Identifier: Apache-2.0 */
/* The nearest centre, four at a time. */
#include "variants.h"

#ifdef T3R_NEON

#include "lanes_neon.h"

#define NEAREST_BEGIN t3r_nearest_begin_neon
#define NEAREST t3r_nearest_neon
#include "kernels/lanes/nearest_lanes.h"

#else
typedef int t3r_no_nearest_neon; /* a file may not be empty */
#endif
