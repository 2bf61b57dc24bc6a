/* SPDX-License-Identifier: Apache-2.0 */
/* Plain C's loops over rows, compiled for SSE4.1. */
#include "kernels/x86/variants.h"

#ifdef T3R_X86

#if defined(__clang__)
#pragma clang attribute push(T3R_SSE41, apply_to = function)
#else
#pragma GCC push_options
#pragma GCC target("sse4.1")
#endif

#define ROW(name) t3r_##name##_sse41

/* Omits loops for which plain C is about equally fast, and others that only rows_avx2.c has. */
#define LEAVE_OUT(name) static inline __attribute__((unused)) t3r_##name##_kernel ROW(name);
LEAVE_OUT(triple_row)
LEAVE_OUT(box_sums)
LEAVE_OUT(divide_row)
LEAVE_OUT(luma_row)
LEAVE_OUT(db2_predict)
LEAVE_OUT(db2_lift)
LEAVE_OUT(db2_join)
LEAVE_OUT(subtract_row)
LEAVE_OUT(cdf53_predict)
LEAVE_OUT(texture_spread)

#include "kernels/lanes/rows.h"

#if defined(__clang__)
#pragma clang attribute pop
#else
#pragma GCC pop_options
#endif

#else
typedef int t3r_no_rows_sse41; /* a file may not be empty */
#endif
