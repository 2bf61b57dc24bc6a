/* SPDX-License-Identifier: Apache-2.0 */
/* The variants for WebAssembly, if the whole module may have vectors: engines without them cannot load it. */
#ifndef T3R_WASM_VARIANTS_H
#define T3R_WASM_VARIANTS_H

#include "kernels/kernels.h"
#include "trim3r.h"

#ifdef __wasm_simd128__
#define T3R_SIMD128 1
#if T3R_FEATURE_LEARNED
#define T3R_SIMD128_LEARNED_VARIANTS_(X)                                                                               \
    X(pack_layer, T3R_CPU_SIMD128, t3r_pack_layer_simd128)                                                             \
    X(convolve_packed, T3R_CPU_SIMD128, t3r_convolve_packed_simd128)
#else
#define T3R_SIMD128_LEARNED_VARIANTS_(X)
#endif
#if T3R_FEATURE_REFINEMENT
#define T3R_SIMD128_REFINEMENT_VARIANTS_(X)                                                                            \
    X(axes, T3R_CPU_SIMD128, t3r_axes_simd128)                                                                         \
    X(scatter, T3R_CPU_SIMD128, t3r_scatter_simd128)                                                                   \
    X(solve, T3R_CPU_SIMD128, t3r_solve_simd128)
#else
#define T3R_SIMD128_REFINEMENT_VARIANTS_(X)
#endif
/* X(entry, features, function), like x86/variants.h. */
#define T3R_WASM_VARIANTS(X)                                                                                           \
    X(nearest_begin, T3R_CPU_SIMD128, t3r_nearest_begin_simd128)                                                       \
    X(nearest, T3R_CPU_SIMD128, t3r_nearest_simd128)                                                                   \
    X(wanted_row, T3R_CPU_SIMD128, t3r_wanted_row_simd128)                                                             \
    X(key_row, T3R_CPU_SIMD128, t3r_key_row_simd128)                                                                   \
    X(project, T3R_CPU_SIMD128, t3r_project_simd128)                                                                   \
    X(place, T3R_CPU_SIMD128, t3r_place_simd128)                                                                       \
    X(blend, T3R_CPU_SIMD128, t3r_blend_simd128)                                                                       \
    X(blend_keep, T3R_CPU_SIMD128, t3r_blend_keep_simd128)                                                             \
    T3R_SIMD128_LEARNED_VARIANTS_(X)                                                                                   \
    T3R_SIMD128_REFINEMENT_VARIANTS_(X)
#else
#define T3R_WASM_VARIANTS(X)
#endif

#if defined(__wasm_simd128__)
#define T3R_WASM_FEATURES T3R_CPU_SIMD128
#else
#define T3R_WASM_FEATURES 0u
#endif

#define T3R_DECLARE_(entry, features, function) __attribute__((visibility("hidden"))) t3r_##entry##_kernel function;
T3R_WASM_VARIANTS(T3R_DECLARE_)
#undef T3R_DECLARE_

#endif
