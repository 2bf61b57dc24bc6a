/* SPDX-License-Identifier: Apache-2.0 */
/* The checks of a frame. */
#ifndef T3R_FRAME_CHECKS_H
#define T3R_FRAME_CHECKS_H

#include <stdbool.h>

#include "core/fault.h"
#include "image.h"

static inline uint32_t t3r_bytes_per_pixel(t3r_pixel_format format)
{
    switch (format) {
    case T3R_PIXEL_RGB24:
    case T3R_PIXEL_BGR24:
        return 3;
    case T3R_PIXEL_YUYV:
    case T3R_PIXEL_UYVY:
        return 2;
    default:
        return 1;
    }
}

static inline bool t3r_is_side(uint32_t side)
{
    return side >= 2 && side <= T3R_MAX_SIDE;
}

/* Whether a plane is usable. A row has `bytes` <= 3 T3R_MAX_SIDE, a stride is below 2^19: every offset is below
 * 2^31. */
static inline bool t3r_is_readable(const uint8_t *plane, uint32_t stride, uint32_t bytes)
{
    return plane != NULL && stride >= bytes && stride <= T3R_MAX_STRIDE_BYTES;
}

#define T3R_SIDE_TEXT_(field) "frame." field " is @: a side of a picture is 2..# pixels"
#define T3R_STRIDE_TEXT_(field)                                                                                        \
    "frame." field " is @: a stride is in bytes, not in pixels, at least the # of a row and at most #"

T3R_CHECKS t3r_plane_checks(const uint8_t *plane, uint32_t stride, uint32_t bytes, const char *no_plane,
                            const char *bad_stride, t3r_fault *fault)
{
    T3R_CHECK(fault, t3r_is_readable(plane, stride, bytes), T3R_ERR_FRAME, plane == NULL ? no_plane : bad_stride,
              stride, bytes, T3R_MAX_STRIDE_BYTES);
    return T3R_OK;
}

T3R_CHECKS t3r_colour_checks(const t3r_frame *frame, t3r_fault *fault)
{
    T3R_CHECK(fault, frame->format < T3R_PIXEL_FORMAT_COUNT, T3R_ERR_FRAME,
              "frame.format is @: a t3r_pixel_format is 0..#", frame->format, T3R_PIXEL_FORMAT_COUNT - 1);
    T3R_CHECK(fault, t3r_is_side(frame->width), T3R_ERR_FRAME, T3R_SIDE_TEXT_("width"), frame->width, T3R_MAX_SIDE);
    T3R_CHECK(fault, t3r_is_side(frame->height), T3R_ERR_FRAME, T3R_SIDE_TEXT_("height"), frame->height, T3R_MAX_SIDE);
    const bool pairs =
        frame->format == T3R_PIXEL_YUYV || frame->format == T3R_PIXEL_UYVY || frame->format == T3R_PIXEL_NV12;
    T3R_CHECK(fault, !pairs || frame->width % 2 == 0, T3R_ERR_FRAME,
              "frame.width is #: T3R_PIXEL_YUYV, UYVY and NV12 have an even width", frame->width);
    t3r_status status =
        t3r_plane_checks(frame->planes[0], frame->stride_bytes[0], frame->width * t3r_bytes_per_pixel(frame->format),
                         "frame.planes[0] is NULL: it is the colour", T3R_STRIDE_TEXT_("stride_bytes[0]"), fault);
    if (status == T3R_OK && frame->format == T3R_PIXEL_NV12) {
        T3R_CHECK(fault, frame->height % 2 == 0, T3R_ERR_FRAME, "frame.height is #: T3R_PIXEL_NV12 has an even height",
                  frame->height);
        status = t3r_plane_checks(frame->planes[1], frame->stride_bytes[1], frame->width,
                                  "frame.planes[1] is NULL: it is the UV plane of T3R_PIXEL_NV12",
                                  T3R_STRIDE_TEXT_("stride_bytes[1]"), fault);
    }
    return status;
}

T3R_CHECKS t3r_depth_checks(const t3r_frame *frame, t3r_fault *fault)
{
    T3R_CHECK(fault, t3r_is_side(frame->depth_width), T3R_ERR_FRAME, T3R_SIDE_TEXT_("depth_width"), frame->depth_width,
              T3R_MAX_SIDE);
    T3R_CHECK(fault, t3r_is_side(frame->depth_height), T3R_ERR_FRAME, T3R_SIDE_TEXT_("depth_height"),
              frame->depth_height, T3R_MAX_SIDE);
    const t3r_status status = t3r_plane_checks(frame->depth, frame->depth_stride_bytes, frame->depth_width * 2, NULL,
                                               T3R_STRIDE_TEXT_("depth_stride_bytes"), fault);
    if (status != T3R_OK) {
        return status;
    }
    T3R_CHECK(fault, frame->depth_unit_q40 != 0 && frame->depth_unit_q40 <= T3R_MAX_DEPTH_UNIT_Q40, T3R_ERR_FRAME,
              "frame.depth_unit_q40 is @: the length of a step of depth is 1..#, in 1/2^40 world unit; a millimetre in "
              "metres is 1099511628",
              frame->depth_unit_q40, T3R_MAX_DEPTH_UNIT_Q40);
    return T3R_OK;
}

T3R_CHECKS t3r_frame_checks(const t3r_frame *frame, t3r_fault *fault)
{
    const t3r_status status = t3r_colour_checks(frame, fault);
    return status == T3R_OK && frame->depth != NULL ? t3r_depth_checks(frame, fault) : status;
}

#endif
