/* SPDX-License-Identifier: Apache-2.0 */
/* The budget's keys, eight at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_avx2.h"

#define WANTED_ROW t3r_wanted_row_avx2
#define KEY_ROW t3r_key_row_avx2
#include "kernels/lanes/keys_lanes.h"

#else
typedef int t3r_no_keys_avx2; /* a file may not be empty */
#endif
