/* SPDX-License-Identifier: Apache-2.0 */
#include "pixel_layout.h"

static const struct {
    const char *encoding, *other;
    uint8_t bytes;
} formats[T3R_PIXEL_FORMAT_COUNT] = {
    [T3R_PIXEL_RGB24] = {"rgb8", "rgb24", 3}, [T3R_PIXEL_BGR24] = {"bgr8", "bgr24", 3},
    [T3R_PIXEL_GREY] = {"mono8", "grey", 1},  [T3R_PIXEL_YUYV] = {"yuv422_yuy2", "yuyv", 2},
    [T3R_PIXEL_UYVY] = {"yuv422", "uyvy", 2}, [T3R_PIXEL_NV12] = {"nv12", "NV12", 1},
};

const char *t3r_pixel_encoding(t3r_pixel_format format)
{
    return formats[format].encoding;
}

bool t3r_pixel_format_of(t3r_text encoding, t3r_pixel_format *format)
{
    for (uint32_t i = 0; i < T3R_PIXEL_FORMAT_COUNT; i++) {
        if (t3r_text_is(encoding, formats[i].encoding) || t3r_text_is(encoding, formats[i].other)) {
            *format = (t3r_pixel_format)i;
            return true;
        }
    }
    *format = T3R_PIXEL_BGR24;
    return t3r_text_is(encoding, "8UC3"); /* OpenCV's three channels are blue, green and red */
}

bool t3r_pixel_is_converted(t3r_text encoding)
{
    static const char *const names[] = {"rgba8",       "bgra8",       "8UC4",       "bayer_rggb8",
                                        "bayer_bggr8", "bayer_gbrg8", "bayer_grbg8"};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (t3r_text_is(encoding, names[i])) {
            return true;
        }
    }
    return false;
}

uint32_t t3r_pixel_row_bytes(t3r_pixel_format format, uint32_t width)
{
    return width * formats[format].bytes;
}

uint32_t t3r_pixel_rows(t3r_pixel_format format, uint32_t plane, uint32_t height)
{
    return plane == 0 ? height : format == T3R_PIXEL_NV12 ? height / 2 : 0;
}

const char *t3r_pixel_size_error(t3r_pixel_format format, uint32_t width, uint32_t height)
{
    if (width < 2 || height < 2 || width > T3R_MAX_SIDE || height > T3R_MAX_SIDE) {
        return "width or height is outside 2..4096";
    }
    bool halves_width = format == T3R_PIXEL_YUYV || format == T3R_PIXEL_UYVY || format == T3R_PIXEL_NV12;
    if (halves_width && width % 2 != 0) {
        return "width is odd, which its encoding cannot be";
    }
    if (format == T3R_PIXEL_NV12 && height % 2 != 0) {
        return "height is odd, which its encoding cannot be";
    }
    return NULL;
}
