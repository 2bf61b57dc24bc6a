/* The processor's vector instructions, without a header of the C library. */
#ifndef T3R_KERNELS_X86_INTRINSICS_H
#define T3R_KERNELS_X86_INTRINSICS_H

#define _MM_MALLOC_H_INCLUDED /* gcc's header would include stdlib.h for an allocator that nothing here calls */
#include <immintrin.h>

/* Of a function whose arguments say what its callers are compiled for. Without optimisation it is called: every
 * intrinsic of an inlined one would take stack for its operands. */
#if defined(__OPTIMIZE__)
#define T3R_X86_INLINE static inline __attribute__((always_inline))
#else
#define T3R_X86_INLINE static inline
#endif

/* Before a loop of a constant number of turns, at most eight, over an array that is to stay in registers. */
#if defined(__clang__)
#define T3R_X86_UNROLL _Pragma("clang loop unroll(full)")
#else
#define T3R_X86_UNROLL _Pragma("GCC unroll 8")
#endif

#endif
