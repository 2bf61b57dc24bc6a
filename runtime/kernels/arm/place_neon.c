/* SPDX-License-Identifier: Apache-2.0 */
/* Splats in a tile, four at a time. */
#include "variants.h"

#ifdef T3R_NEON

#include "lanes_neon.h"

#define PLACE t3r_place_neon
#include "kernels/lanes/place_lanes.h"

#else
typedef int t3r_no_place_neon; /* a file may not be empty */
#endif
