/* SPDX-License-Identifier: Apache-2.0 */
/* The variants for x86-64. Each function is compiled for its own instruction set by an attribute, so that the library
 * runs on every x86-64. A build for general registers only has none. */
#ifndef T3R_X86_VARIANTS_H
#define T3R_X86_VARIANTS_H

#include "kernels/kernels.h"
#include "kernels/x86/processor.h"
#include "trim3r.h"

#if defined(__x86_64__) && defined(__SSE2__)
#define T3R_X86 1
#define T3R_SSE41 __attribute__((target("sse4.1")))
#define T3R_AVX2 __attribute__((target("avx2")))
#define T3R_AVX512 __attribute__((target("avx2,avx512f,avx512bw,avx512cd,avx512dq,avx512vl")))
#define T3R_VNNI __attribute__((target("avx2,avx512f,avx512bw,avx512cd,avx512dq,avx512vl,avx512vnni")))
#define T3R_CPU_X86_VNNI_ (T3R_CPU_AVX2 | T3R_CPU_AVX512 | T3R_CPU_VNNI)
/* Without optimization each step of these has a frame with 64-byte vectors: 20 KiB of stack for projection, 6 for the
 * hash. */
#ifdef __OPTIMIZE__
#define T3R_X86_OPTIMIZED 1
#define T3R_X86_OPTIMIZED_(X)                                                                                          \
    X(project, T3R_CPU_AVX2 | T3R_CPU_AVX512, t3r_project_avx512)                                                      \
    X(hash_bytes, T3R_CPU_AVX2 | T3R_CPU_AVX512, t3r_hash_bytes_avx512)
#if T3R_FEATURE_REFINEMENT
#define T3R_X86_OPTIMIZED_REFINEMENT_(X) X(axes, T3R_CPU_AVX2 | T3R_CPU_AVX512, t3r_axes_avx512)
#else
#define T3R_X86_OPTIMIZED_REFINEMENT_(X)
#endif
#else
#define T3R_X86_OPTIMIZED_(X)
#define T3R_X86_OPTIMIZED_REFINEMENT_(X)
#endif
/* Variants of features that a library may be built without. */
#if T3R_FEATURE_STEREO
#define T3R_X86_STEREO_VARIANTS_(X)                                                                                    \
    X(census_row, T3R_CPU_AVX2, t3r_census_row_avx2)                                                                   \
    X(census_costs, T3R_CPU_SSE41, t3r_census_costs_sse41)                                                             \
    X(census_costs, T3R_CPU_AVX2, t3r_census_costs_avx2)                                                               \
    X(disparity_at, T3R_CPU_AVX2, t3r_disparity_at_avx2)                                                               \
    X(ray_row, T3R_CPU_AVX2, t3r_ray_row_avx2)                                                                         \
    X(ray_row, T3R_CPU_AVX2 | T3R_CPU_AVX512, t3r_ray_row_avx512)                                                      \
    X(luma_at, T3R_CPU_AVX2, t3r_luma_at_avx2)                                                                         \
    X(path_row, T3R_CPU_SSE41, t3r_path_row_sse41)                                                                     \
    X(path_row, T3R_CPU_AVX2, t3r_path_row_avx2)                                                                       \
    X(winner_row, T3R_CPU_SSE41, t3r_winner_row_sse41)                                                                 \
    X(winner_row, T3R_CPU_AVX2, t3r_winner_row_avx2)
#else
#define T3R_X86_STEREO_VARIANTS_(X)
#endif
#if T3R_FEATURE_LEARNED
#define T3R_X86_LEARNED_VARIANTS_(X)                                                                                   \
    X(convolve, T3R_CPU_AVX2, t3r_convolve_avx2)                                                                       \
    X(depthwise, T3R_CPU_AVX2, t3r_depthwise_avx2)                                                                     \
    X(pack_layer, T3R_CPU_SSE41, t3r_pack_layer_sse41)                                                                 \
    X(pack_layer, T3R_CPU_AVX2, t3r_pack_layer_avx2)                                                                   \
    X(pack_layer, T3R_CPU_X86_VNNI_, t3r_pack_layer_vnni)                                                              \
    X(convolve_packed, T3R_CPU_SSE41, t3r_convolve_packed_sse41)                                                       \
    X(convolve_packed, T3R_CPU_AVX2, t3r_convolve_packed_avx2)                                                         \
    X(convolve_packed, T3R_CPU_X86_VNNI_, t3r_convolve_packed_vnni)
#else
#define T3R_X86_LEARNED_VARIANTS_(X)
#endif
#if T3R_FEATURE_REFINEMENT
#define T3R_X86_REFINEMENT_VARIANTS_(X)                                                                                \
    X(axes, T3R_CPU_SSE41, t3r_axes_sse41)                                                                             \
    X(axes, T3R_CPU_AVX2, t3r_axes_avx2)                                                                               \
    X(compare_row, T3R_CPU_AVX2, t3r_compare_row_avx2)                                                                 \
    X(scatter, T3R_CPU_SSE41, t3r_scatter_sse41)                                                                       \
    X(scatter, T3R_CPU_AVX2, t3r_scatter_avx2)                                                                         \
    X(scatter, T3R_CPU_X86_VNNI_, t3r_scatter_vnni)                                                                    \
    X(solve, T3R_CPU_SSE41, t3r_solve_sse41)                                                                           \
    X(solve, T3R_CPU_AVX2, t3r_solve_avx2)                                                                             \
    T3R_X86_OPTIMIZED_REFINEMENT_(X)
#else
#define T3R_X86_REFINEMENT_VARIANTS_(X)
#endif
/* X(entry, features, function); the function has the entry's type. */
#define T3R_X86_VARIANTS(X)                                                                                            \
    X(packed_row, T3R_CPU_SSE41, t3r_packed_row_sse41)                                                                 \
    X(packed_row, T3R_CPU_AVX2, t3r_packed_row_avx2)                                                                   \
    X(nv12_row, T3R_CPU_SSE41, t3r_nv12_row_sse41)                                                                     \
    X(nv12_row, T3R_CPU_AVX2, t3r_nv12_row_avx2)                                                                       \
    X(triple_row, T3R_CPU_AVX2, t3r_triple_row_avx2)                                                                   \
    X(box_sums, T3R_CPU_AVX2, t3r_box_sums_avx2)                                                                       \
    X(weigh_row, T3R_CPU_SSE41, t3r_weigh_row_sse41)                                                                   \
    X(weigh_row, T3R_CPU_AVX2, t3r_weigh_row_avx2)                                                                     \
    X(divide_row, T3R_CPU_AVX2, t3r_divide_row_avx2)                                                                   \
    X(unproject, T3R_CPU_AVX2, t3r_unproject_avx2)                                                                     \
    X(unproject, T3R_CPU_AVX2 | T3R_CPU_AVX512, t3r_unproject_avx512)                                                  \
    X(locate, T3R_CPU_AVX2, t3r_locate_avx2)                                                                           \
    X(locate, T3R_CPU_AVX2 | T3R_CPU_AVX512, t3r_locate_avx512)                                                        \
    X(luma_row, T3R_CPU_AVX2, t3r_luma_row_avx2)                                                                       \
    X(split_row, T3R_CPU_SSE41, t3r_split_row_sse41)                                                                   \
    X(split_row, T3R_CPU_AVX2, t3r_split_row_avx2)                                                                     \
    X(db2_predict, T3R_CPU_AVX2, t3r_db2_predict_avx2)                                                                 \
    X(db2_lift, T3R_CPU_AVX2, t3r_db2_lift_avx2)                                                                       \
    X(db2_split, T3R_CPU_SSE41, t3r_db2_split_sse41)                                                                   \
    X(db2_split, T3R_CPU_AVX2, t3r_db2_split_avx2)                                                                     \
    X(db2_join, T3R_CPU_AVX2, t3r_db2_join_avx2)                                                                       \
    X(subtract_row, T3R_CPU_AVX2, t3r_subtract_row_avx2)                                                               \
    X(haar_update, T3R_CPU_SSE41, t3r_haar_update_sse41)                                                               \
    X(haar_update, T3R_CPU_AVX2, t3r_haar_update_avx2)                                                                 \
    X(cdf53_predict, T3R_CPU_AVX2, t3r_cdf53_predict_avx2)                                                             \
    X(cdf53_update, T3R_CPU_SSE41, t3r_cdf53_update_sse41)                                                             \
    X(cdf53_update, T3R_CPU_AVX2, t3r_cdf53_update_avx2)                                                               \
    X(texture_finest, T3R_CPU_SSE41, t3r_texture_finest_sse41)                                                         \
    X(texture_finest, T3R_CPU_AVX2, t3r_texture_finest_avx2)                                                           \
    X(texture_coarse, T3R_CPU_SSE41, t3r_texture_coarse_sse41)                                                         \
    X(texture_coarse, T3R_CPU_AVX2, t3r_texture_coarse_avx2)                                                           \
    X(texture_add, T3R_CPU_SSE41, t3r_texture_add_sse41)                                                               \
    X(texture_add, T3R_CPU_AVX2, t3r_texture_add_avx2)                                                                 \
    X(texture_spread, T3R_CPU_AVX2, t3r_texture_spread_avx2)                                                           \
    X(sample_potential, T3R_CPU_SSE41, t3r_sample_potential_sse41)                                                     \
    X(sample_potential, T3R_CPU_AVX2, t3r_sample_potential_avx2)                                                       \
    X(sample_potential, T3R_CPU_AVX2 | T3R_CPU_AVX512, t3r_sample_potential_avx512)                                    \
    X(sample_approach, T3R_CPU_SSE41, t3r_sample_approach_sse41)                                                       \
    X(sample_approach, T3R_CPU_AVX2, t3r_sample_approach_avx2)                                                         \
    X(sample_approach, T3R_CPU_AVX2 | T3R_CPU_AVX512, t3r_sample_approach_avx512)                                      \
    X(nearest_begin, T3R_CPU_SSE41, t3r_nearest_begin_sse41)                                                           \
    X(nearest_begin, T3R_CPU_AVX2, t3r_nearest_begin_avx2)                                                             \
    X(nearest, T3R_CPU_SSE41, t3r_nearest_sse41)                                                                       \
    X(nearest, T3R_CPU_AVX2, t3r_nearest_avx2)                                                                         \
    X(nearest, T3R_CPU_X86_VNNI_, t3r_nearest_vnni)                                                                    \
    X(blur_row, T3R_CPU_AVX2, t3r_blur_row_avx2)                                                                       \
    X(blur_column, T3R_CPU_AVX2, t3r_blur_column_avx2)                                                                 \
    X(wanted_row, T3R_CPU_SSE41, t3r_wanted_row_sse41)                                                                 \
    X(wanted_row, T3R_CPU_AVX2, t3r_wanted_row_avx2)                                                                   \
    X(key_row, T3R_CPU_SSE41, t3r_key_row_sse41)                                                                       \
    X(key_row, T3R_CPU_AVX2, t3r_key_row_avx2)                                                                         \
    X(project, T3R_CPU_SSE41, t3r_project_sse41)                                                                       \
    X(project, T3R_CPU_AVX2, t3r_project_avx2)                                                                         \
    X(place, T3R_CPU_SSE41, t3r_place_sse41)                                                                           \
    X(place, T3R_CPU_AVX2, t3r_place_avx2)                                                                             \
    X(blend, T3R_CPU_SSE41, t3r_blend_sse41)                                                                           \
    X(blend, T3R_CPU_AVX2, t3r_blend_avx2)                                                                             \
    X(blend_keep, T3R_CPU_SSE41, t3r_blend_keep_sse41)                                                                 \
    X(blend_keep, T3R_CPU_AVX2, t3r_blend_keep_avx2)                                                                   \
    T3R_X86_OPTIMIZED_(X)                                                                                              \
    T3R_X86_STEREO_VARIANTS_(X)                                                                                        \
    T3R_X86_LEARNED_VARIANTS_(X)                                                                                       \
    T3R_X86_REFINEMENT_VARIANTS_(X)
/* Bytes of an activation that convolve_packed of these features reads. */
#define T3R_X86_STRIP_BYTES(cpu) (((cpu)&T3R_CPU_X86_VNNI_) == T3R_CPU_X86_VNNI_ ? 1u : 2u)
#else
#define T3R_X86_VARIANTS(X)
#define T3R_X86_STRIP_BYTES(cpu) 2u
#endif

#if defined(__x86_64__)
#define T3R_X86_FEATURES t3r_x86_features()
#else
#define T3R_X86_FEATURES 0u
#endif

#define T3R_DECLARE_(entry, features, function) __attribute__((visibility("hidden"))) t3r_##entry##_kernel function;
T3R_X86_VARIANTS(T3R_DECLARE_)
#undef T3R_DECLARE_

#endif
