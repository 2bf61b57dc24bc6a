/* SPDX-License-Identifier: Apache-2.0 */
/* The budget's keys, four at a time. */
#include "variants.h"

#ifdef T3R_SIMD128

#include "lanes_simd128.h"

#define WANTED_ROW t3r_wanted_row_simd128
#define KEY_ROW t3r_key_row_simd128
#include "kernels/lanes/keys_lanes.h"

#else
typedef int t3r_no_keys_simd128; /* a file may not be empty */
#endif
