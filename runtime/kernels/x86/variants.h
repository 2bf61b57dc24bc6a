/* The variants for x86-64. Each function is compiled for its own instruction set by an attribute, so that the library
 * as a whole runs on every x86-64. A build for general registers alone has none. */
#ifndef T3R_X86_VARIANTS_H
#define T3R_X86_VARIANTS_H

#include "kernels/kernels.h"
#include "trim3r.h"

#if defined(__x86_64__) && defined(__SSE2__)
#define T3R_X86 1
#define T3R_AVX2 __attribute__((target("avx2")))
#define T3R_VNNI __attribute__((target("avx2,avx512f,avx512bw,avx512dq,avx512vl,avx512vnni")))
#define T3R_CPU_X86_VNNI_ (T3R_CPU_AVX2 | T3R_CPU_AVX512 | T3R_CPU_VNNI)
/* X(entry, features, function): its type is the entry's. */
#define T3R_X86_VARIANTS(X)                                                                                            \
    X(nearest_begin, T3R_CPU_AVX2, t3r_nearest_begin_avx2)                                                             \
    X(nearest, T3R_CPU_AVX2, t3r_nearest_avx2)                                                                         \
    X(convolve, T3R_CPU_AVX2, t3r_convolve_avx2)                                                                       \
    X(convolve, T3R_CPU_X86_VNNI_, t3r_convolve_vnni)                                                                  \
    X(depthwise, T3R_CPU_AVX2, t3r_depthwise_avx2)                                                                     \
    X(blend, T3R_CPU_AVX2, t3r_blend_avx2)
#else
#define T3R_X86_VARIANTS(X)
#endif

#define T3R_DECLARE_(entry, features, function) __attribute__((visibility("hidden"))) t3r_##entry##_kernel function;
T3R_X86_VARIANTS(T3R_DECLARE_)
#undef T3R_DECLARE_

#endif
