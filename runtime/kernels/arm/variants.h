/* SPDX-License-Identifier: Apache-2.0 */
/* The variants for Arm. Variants for a Cortex-M exist only in builds for a core that has the instructions, because a
 * firmware knows its core. */
#ifndef T3R_ARM_VARIANTS_H
#define T3R_ARM_VARIANTS_H

#include "kernels/kernels.h"
#include "trim3r.h"

/* Without optimization gcc has no registers left for the operands. */
#if defined(__ARM_FEATURE_MVE) && (__ARM_FEATURE_MVE & 1) != 0 && !defined(__ARM_BIG_ENDIAN) && defined(__OPTIMIZE__)
#define T3R_MVE 1
#if T3R_FEATURE_LEARNED
#define T3R_MVE_LEARNED_VARIANTS_(X) X(convolve, T3R_CPU_MVE, t3r_convolve_mve)
#else
#define T3R_MVE_LEARNED_VARIANTS_(X)
#endif
#if T3R_FEATURE_REFINEMENT
#define T3R_MVE_REFINEMENT_VARIANTS_(X)                                                                                \
    X(blend_keep, T3R_CPU_MVE, t3r_blend_keep_mve)                                                                     \
    X(scatter, T3R_CPU_MVE, t3r_scatter_mve)
#else
#define T3R_MVE_REFINEMENT_VARIANTS_(X)
#endif
#define T3R_MVE_VARIANTS_(X)                                                                                           \
    X(sample_potential, T3R_CPU_MVE, t3r_sample_potential_mve)                                                         \
    X(sample_approach, T3R_CPU_MVE, t3r_sample_approach_mve)                                                           \
    X(nearest_begin, T3R_CPU_MVE, t3r_nearest_begin_mve)                                                               \
    X(nearest, T3R_CPU_MVE, t3r_nearest_mve)                                                                           \
    X(blend, T3R_CPU_MVE, t3r_blend_mve)                                                                               \
    T3R_MVE_LEARNED_VARIANTS_(X)                                                                                       \
    T3R_MVE_REFINEMENT_VARIANTS_(X)
#else
#define T3R_MVE_VARIANTS_(X)
#endif

/* Again only with optimization. */
#if defined(__ARM_FEATURE_DSP) && defined(__OPTIMIZE__) && __ARM_ARCH_PROFILE == 'M' && !defined(T3R_MVE) &&           \
    !defined(__ARM_BIG_ENDIAN)
#define T3R_DSP 1
#if T3R_FEATURE_LEARNED
#define T3R_DSP_LEARNED_VARIANTS_(X) X(convolve, T3R_CPU_DSP, t3r_convolve_dsp)
#else
#define T3R_DSP_LEARNED_VARIANTS_(X)
#endif
#if T3R_FEATURE_REFINEMENT
#define T3R_DSP_REFINEMENT_VARIANTS_(X)                                                                                \
    X(blend_keep, T3R_CPU_DSP, t3r_blend_keep_dsp)                                                                     \
    X(scatter, T3R_CPU_DSP, t3r_scatter_dsp)
#else
#define T3R_DSP_REFINEMENT_VARIANTS_(X)
#endif
#define T3R_DSP_VARIANTS_(X)                                                                                           \
    X(nearest_begin, T3R_CPU_DSP, t3r_nearest_begin_dsp)                                                               \
    X(nearest, T3R_CPU_DSP, t3r_nearest_dsp)                                                                           \
    X(blend, T3R_CPU_DSP, t3r_blend_dsp)                                                                               \
    T3R_DSP_LEARNED_VARIANTS_(X)                                                                                       \
    T3R_DSP_REFINEMENT_VARIANTS_(X)
#else
#define T3R_DSP_VARIANTS_(X)
#endif

/* Every 64-bit Arm has NEON; builds for general registers only do not use it. */
#if defined(__aarch64__) && defined(__ARM_NEON) && !defined(__ARM_BIG_ENDIAN)
#define T3R_NEON 1
/* A build for SVE without dot products has no assembler for both. */
#if T3R_FEATURE_LEARNED && (defined(__ARM_FEATURE_DOTPROD) || !defined(__ARM_FEATURE_SVE))
#define T3R_NEON_LEARNED 1
#define T3R_CPU_ARM_DOTPROD_ (T3R_CPU_NEON | T3R_CPU_DOTPROD)
#define T3R_NEON_LEARNED_VARIANTS_(X)                                                                                  \
    X(pack_layer, T3R_CPU_ARM_DOTPROD_, t3r_pack_layer_dotprod)                                                        \
    X(convolve_packed, T3R_CPU_ARM_DOTPROD_, t3r_convolve_packed_dotprod)
/* Bytes of an activation that convolve_packed of these features reads. */
#define T3R_ARM_STRIP_BYTES(cpu) (((cpu)&T3R_CPU_ARM_DOTPROD_) == T3R_CPU_ARM_DOTPROD_ ? 1u : 2u)
#else
#define T3R_NEON_LEARNED_VARIANTS_(X)
#endif
#if T3R_FEATURE_REFINEMENT
#define T3R_NEON_REFINEMENT_VARIANTS_(X)                                                                               \
    X(axes, T3R_CPU_NEON, t3r_axes_neon)                                                                               \
    X(scatter, T3R_CPU_NEON, t3r_scatter_neon)                                                                         \
    X(solve, T3R_CPU_NEON, t3r_solve_neon)
#else
#define T3R_NEON_REFINEMENT_VARIANTS_(X)
#endif
#define T3R_NEON_VARIANTS_(X)                                                                                          \
    X(nearest_begin, T3R_CPU_NEON, t3r_nearest_begin_neon)                                                             \
    X(nearest, T3R_CPU_NEON, t3r_nearest_neon)                                                                         \
    X(project, T3R_CPU_NEON, t3r_project_neon)                                                                         \
    X(place, T3R_CPU_NEON, t3r_place_neon)                                                                             \
    T3R_NEON_LEARNED_VARIANTS_(X)                                                                                      \
    T3R_NEON_REFINEMENT_VARIANTS_(X)
#else
#define T3R_NEON_VARIANTS_(X)
#endif

/* X(entry, features, function), like x86/variants.h. */
#define T3R_ARM_VARIANTS(X) T3R_DSP_VARIANTS_(X) T3R_MVE_VARIANTS_(X) T3R_NEON_VARIANTS_(X)

#ifndef T3R_ARM_STRIP_BYTES
#define T3R_ARM_STRIP_BYTES(cpu) 2u
#endif

/* Features of the architecture, or of the core that a firmware is compiled for. */
#if defined(__aarch64__)
#define T3R_ARM_FEATURES (T3R_CPU_NEON | T3R_CPU_DOTPROD)
#elif defined(__ARM_FEATURE_MVE)
#define T3R_ARM_FEATURES (T3R_CPU_MVE | T3R_CPU_DSP)
#elif defined(__ARM_FEATURE_DSP)
#define T3R_ARM_FEATURES T3R_CPU_DSP
#else
#define T3R_ARM_FEATURES 0u
#endif

#define T3R_DECLARE_(entry, features, function) __attribute__((visibility("hidden"))) t3r_##entry##_kernel function;
T3R_ARM_VARIANTS(T3R_DECLARE_)
#undef T3R_DECLARE_

#endif
