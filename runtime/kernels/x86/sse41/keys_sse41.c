/* SPDX-License-Identifier: Apache-2.0 */
/* The budget's keys, four at a time. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#include "lanes_sse41.h"

#define WANTED_ROW t3r_wanted_row_sse41
#define KEY_ROW t3r_key_row_sse41
#include "kernels/lanes/keys_lanes.h"

#else
typedef int t3r_no_keys_sse41; /* a file may not be empty */
#endif
