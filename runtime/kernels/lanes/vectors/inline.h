/* SPDX-License-Identifier: Apache-2.0 */
/* Inlining of vector functions, and unrolling of short loops. */
#ifndef T3R_KERNELS_LANES_INLINE_H
#define T3R_KERNELS_LANES_INLINE_H

/* For functions whose argument types require their callers' target. Without optimisation they are called: if inlined,
 * every intrinsic would take stack for its operands. */
#if defined(__OPTIMIZE__)
#define T3R_LANES_INLINE static inline __attribute__((always_inline))
#else
#define T3R_LANES_INLINE static inline
#endif

/* Before a loop of constant length, at most eight, over an array that must stay in registers. */
#if defined(__clang__)
#define T3R_LANES_UNROLL _Pragma("clang loop unroll(full)")
#else
#define T3R_LANES_UNROLL _Pragma("GCC unroll 8")
#endif

#endif
