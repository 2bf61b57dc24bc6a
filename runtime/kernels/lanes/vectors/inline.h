/* SPDX-License-Identifier: Apache-2.0 */
/* How functions of vectors are inlined, and loops over a few of them unrolled. */
#ifndef T3R_KERNELS_LANES_INLINE_H
#define T3R_KERNELS_LANES_INLINE_H

/* Of a function whose arguments say what its callers are compiled for. Without optimisation it is called: every
 * intrinsic of an inlined one would take stack for its operands. */
#if defined(__OPTIMIZE__)
#define T3R_LANES_INLINE static inline __attribute__((always_inline))
#else
#define T3R_LANES_INLINE static inline
#endif

/* Before a loop of a constant number of turns, at most eight, over an array that is to stay in registers. */
#if defined(__clang__)
#define T3R_LANES_UNROLL _Pragma("clang loop unroll(full)")
#else
#define T3R_LANES_UNROLL _Pragma("GCC unroll 8")
#endif

#endif
