/* SPDX-License-Identifier: Apache-2.0 */
/* Pixels of four channels. */
#include "trim3r_host.h"

#define HALF_OPAQUE 128
#define ALPHA_ONE 32767u /* of alpha_q15 */

bool t3r_rgb_of_rgba(const uint8_t *rgba, size_t rgba_stride_bytes, uint32_t width, uint32_t height, bool blue_first,
                     uint8_t *rgb, size_t rgb_stride_bytes, uint8_t *opaque)
{
    const int red = blue_first ? 2 : 0, blue = 2 - red;
    bool any = false;
    for (uint32_t y = 0; y < height; y++) {
        const uint8_t *in = rgba + y * rgba_stride_bytes;
        uint8_t *out = rgb + y * rgb_stride_bytes;
        for (uint32_t x = 0; x < width; x++, in += 4, out += 3) {
            const bool is_opaque = in[3] >= HALF_OPAQUE;
            const uint8_t first = in[red], last = in[blue];
            out[0] = first;
            out[1] = in[1];
            out[2] = last;
            any = any || is_opaque;
            if (opaque != NULL) {
                *opaque++ = is_opaque;
            }
        }
    }
    return any;
}

void t3r_rgba_of_view(const t3r_target *view, uint8_t *rgba, size_t rgba_stride_bytes)
{
    for (uint32_t y = 0; y < view->height; y++) {
        const uint8_t *in = view->rgb + (size_t)y * view->rgb_stride_bytes;
        const uint16_t *alpha =
            view->alpha_q15 == NULL ? NULL : view->alpha_q15 + (size_t)y * view->alpha_stride_bytes / sizeof *alpha;
        uint8_t *out = rgba + y * rgba_stride_bytes;
        for (uint32_t x = 0; x < view->width; x++, in += 3, out += 4) {
            out[0] = in[0];
            out[1] = in[1];
            out[2] = in[2];
            out[3] = alpha == NULL ? UINT8_MAX : (uint8_t)((alpha[x] * UINT8_MAX + ALPHA_ONE / 2) / ALPHA_ONE);
        }
    }
}
