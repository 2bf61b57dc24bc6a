/* SPDX-License-Identifier: Apache-2.0 */
/* The structs of trim3r.h, field by field, on which a program and the library must agree. Each side compiles a digest
 * of them; the calls that start a program compare the two. */
#ifndef TRIM3R_INTERFACE_H
#define TRIM3R_INTERFACE_H

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
#define T3R_FIELD_BYTES_(type, field) sizeof(type::field)
#define T3R_STATIC_ASSERT_ static_assert
#define T3R_ALIGNOF_ alignof
#else
#define T3R_FIELD_BYTES_(type, field) sizeof(((const type *)0)->field)
#define T3R_STATIC_ASSERT_ _Static_assert
#define T3R_ALIGNOF_ _Alignof
#endif

/* A struct whose fields lie elsewhere if the program packs structs: under a #pragma pack that is still open, or with
 * -fpack-struct. Such a program does not compile. */
struct t3r_unpacked_ {
    uint8_t before_number;
    uint64_t number;
    uint8_t before_pointer;
    const void *pointer;
};
T3R_STATIC_ASSERT_(offsetof(struct t3r_unpacked_, number) % T3R_ALIGNOF_(uint64_t) == 0 &&
                       offsetof(struct t3r_unpacked_, pointer) % T3R_ALIGNOF_(const void *) == 0,
                   "trim3r.h is included where structs are packed, which changes its structs");

/* FNV-1a by words instead of bytes. */
#define T3R_DIGEST_(word) digest = (digest ^ (word)) * 1099511628211u;
#define T3R_DIGEST_TYPE_(type) T3R_DIGEST_(sizeof(type))
#define T3R_DIGEST_FIELD_(type, field) T3R_DIGEST_(offsetof(type, field)) T3R_DIGEST_(T3R_FIELD_BYTES_(type, field))

#define T3R_DIGEST_SETTING_(name, ...) T3R_DIGEST_(sizeof #name)

/* X(type), a row a struct. */
#define T3R_INTERFACE_TYPES_(X)                                                                                        \
    X(t3r_frame)                                                                                                       \
    X(t3r_camera)                                                                                                      \
    X(t3r_config)                                                                                                      \
    X(t3r_request)                                                                                                     \
    X(t3r_least)                                                                                                       \
    X(t3r_scene_frame)                                                                                                 \
    X(t3r_gaussian)                                                                                                    \
    X(t3r_scene)                                                                                                       \
    X(t3r_target)                                                                                                      \
    X(t3r_hooks)                                                                                                       \
    X(t3r_plan_buffer)                                                                                                 \
    X(t3r_plan_info)                                                                                                   \
    X(t3r_stream_report)

/* X(type, field), a row a field; T3R_SETTINGS has those of t3r_config. */
#define T3R_INTERFACE_FIELDS_(X)                                                                                       \
    X(t3r_frame, format)                                                                                               \
    X(t3r_frame, width)                                                                                                \
    X(t3r_frame, height)                                                                                               \
    X(t3r_frame, planes)                                                                                               \
    X(t3r_frame, stride_bytes)                                                                                         \
    X(t3r_frame, depth)                                                                                                \
    X(t3r_frame, depth_width)                                                                                          \
    X(t3r_frame, depth_height)                                                                                         \
    X(t3r_frame, depth_stride_bytes)                                                                                   \
    X(t3r_frame, depth_unit_q40)                                                                                       \
    X(t3r_camera, width)                                                                                               \
    X(t3r_camera, height)                                                                                              \
    X(t3r_camera, fx_q16)                                                                                              \
    X(t3r_camera, fy_q16)                                                                                              \
    X(t3r_camera, cx_q16)                                                                                              \
    X(t3r_camera, cy_q16)                                                                                              \
    X(t3r_camera, distortion)                                                                                          \
    X(t3r_camera, distortion_q24)                                                                                      \
    X(t3r_camera, position_q32)                                                                                        \
    X(t3r_camera, rotation_q30)                                                                                        \
    X(t3r_request, gaussians)                                                                                          \
    X(t3r_request, max_loss_q8)                                                                                        \
    X(t3r_request, allocate)                                                                                           \
    X(t3r_request, head)                                                                                               \
    X(t3r_request, importance)                                                                                         \
    X(t3r_request, importance_stride_bytes)                                                                            \
    X(t3r_least, psnr_q8)                                                                                              \
    X(t3r_least, builds)                                                                                               \
    X(t3r_scene_frame, origin_q32)                                                                                     \
    X(t3r_scene_frame, exponent)                                                                                       \
    X(t3r_gaussian, position_q20)                                                                                      \
    X(t3r_gaussian, factor)                                                                                            \
    X(t3r_gaussian, factor_exponent)                                                                                   \
    X(t3r_gaussian, view)                                                                                              \
    X(t3r_gaussian, colour_q7)                                                                                         \
    X(t3r_gaussian, opacity_q15)                                                                                       \
    X(t3r_gaussian, confidence)                                                                                        \
    X(t3r_gaussian, reserved)                                                                                          \
    X(t3r_scene, frame)                                                                                                \
    X(t3r_scene, gaussians)                                                                                            \
    X(t3r_scene, count)                                                                                                \
    X(t3r_scene, valid_points)                                                                                         \
    X(t3r_target, width)                                                                                               \
    X(t3r_target, height)                                                                                              \
    X(t3r_target, rgb)                                                                                                 \
    X(t3r_target, rgb_stride_bytes)                                                                                    \
    X(t3r_target, depth_q20)                                                                                           \
    X(t3r_target, depth_stride_bytes)                                                                                  \
    X(t3r_target, alpha_q15)                                                                                           \
    X(t3r_target, alpha_stride_bytes)                                                                                  \
    X(t3r_hooks, user)                                                                                                 \
    X(t3r_hooks, progress)                                                                                             \
    X(t3r_hooks, stage_hash)                                                                                           \
    X(t3r_hooks, parallel_for)                                                                                         \
    X(t3r_plan_buffer, name)                                                                                           \
    X(t3r_plan_buffer, offset)                                                                                         \
    X(t3r_plan_buffer, bytes)                                                                                          \
    X(t3r_plan_buffer, first)                                                                                          \
    X(t3r_plan_buffer, last)                                                                                           \
    X(t3r_plan_info, min_bytes)                                                                                        \
    X(t3r_plan_info, bytes)                                                                                            \
    X(t3r_plan_info, most_blends)                                                                                      \
    X(t3r_plan_info, buffer_count)                                                                                     \
    X(t3r_plan_info, buffers)                                                                                          \
    X(t3r_stream_report, keyframes)                                                                                    \
    X(t3r_stream_report, gaussians)                                                                                    \
    X(t3r_stream_report, added)                                                                                        \
    X(t3r_stream_report, removed)                                                                                      \
    X(t3r_stream_report, crowded)                                                                                      \
    X(t3r_stream_report, points)                                                                                       \
    X(t3r_stream_report, shown)                                                                                        \
    X(t3r_stream_report, refusal)                                                                                      \
    X(t3r_stream_report, moved)                                                                                        \
    X(t3r_stream_report, realigned)                                                                                    \
    X(t3r_stream_report, depth_q8)                                                                                     \
    X(t3r_stream_report, dark_q8)                                                                                      \
    X(t3r_stream_report, bright_q8)                                                                                    \
    X(t3r_stream_report, detail_q8)                                                                                    \
    X(t3r_stream_report, compared)                                                                                     \
    X(t3r_stream_report, contradicted_q8)                                                                              \
    X(t3r_stream_report, likeness_q8)                                                                                  \
    X(t3r_stream_report, recent)                                                                                       \
    X(t3r_stream_report, in_view_q8)                                                                                   \
    X(t3r_stream_report, hidden_q8)                                                                                    \
    X(t3r_stream_report, hidden_likeness_q8)                                                                           \
    X(t3r_stream_report, exposure_q8)

#endif
