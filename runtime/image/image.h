/* SPDX-License-Identifier: Apache-2.0 */
/* Stage image, first part: camera frames to R, G, B and depth planes of the working size.
 *
 * Colour is the exact area average of the source pixels under each destination pixel (when enlarging, too),
 * depth the source pixel at the centre of the box. Each sample is rounded once (SPEC, "Image"). */
#ifndef T3R_IMAGE_H
#define T3R_IMAGE_H

#include <stddef.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "trim3r.h"

/* Largest row stride of a frame or depth plane, in bytes: T3R_MAX_SIDE such rows stay below 2^31. */
#define T3R_MAX_STRIDE_BYTES ((1u << 19) - 1)
/* Largest depth step, 128 world units: 65535 steps fit 63 bits. */
#define T3R_MAX_DEPTH_UNIT_Q40 ((UINT64_C(1) << 47) - 1)

/* Checks a frame without reading pixels. Returns T3R_ERR_ARGUMENT for NULL, T3R_ERR_FRAME when the format, a size,
 * plane, stride or depth field is outside what t3r_frame and the limits above allow. */
t3r_status t3r_image_check(const t3r_frame *frame);

/* Returns the bytes of `work` of t3r_image_colour() for a destination of that width: 24 a pixel. */
size_t t3r_image_work_bytes(uint32_t width);

/* Converts rows begin..end - 1 of a checked frame to R, G, B planes of width x height (1..T3R_MAX_SIDE each), rows
 * without gaps. work: t3r_image_work_bytes(width), aligned for uint32_t; unused (may be NULL) when no size changes. */
void t3r_image_colour(const t3r_kernels *kernels, const t3r_frame *frame, uint32_t width, uint32_t height,
                      uint32_t begin, uint32_t end, uint8_t *const planes[3], void *work);

/* Converts rows begin..end - 1 of a checked frame's depth to width x height steps of its unit, 0 = none; all 0 when the
 * frame has no depth. */
void t3r_image_depth(const t3r_frame *frame, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                     uint16_t *depth);

/* Do the same by strips in order from the first row on: rows first..first + count - 1 of a checked frame, whose planes
 * begin with the first of them. With NV12 both numbers are even. `work` must be kept from strip to strip. */
void t3r_image_colour_strip(const t3r_kernels *kernels, const t3r_frame *frame, uint32_t width, uint32_t height,
                            uint32_t first, uint32_t count, uint8_t *const planes[3], void *work);
void t3r_image_depth_strip(const t3r_frame *frame, uint32_t width, uint32_t height, uint32_t first, uint32_t count,
                           uint16_t *depth);

#endif
