/* SPDX-License-Identifier: Apache-2.0 */
/* Pixels of a camera to R G B. */
#include "row_checks.h"

/* Returns `level` of 0..most as a level of 0..255, rounded to nearest. */
static uint8_t widened(uint32_t level, uint32_t most)
{
    return (uint8_t)((level * 255 + most / 2) / most);
}

static void unpack_rgb565(const uint8_t *packed, uint32_t high, uint32_t width, uint8_t *rgb)
{
    for (uint32_t x = 0; x < width; x++, packed += 2, rgb += 3) {
        const uint32_t pixel = (uint32_t)packed[high] << 8 | packed[1 - high];
        rgb[0] = widened(pixel >> 11, 31);
        rgb[1] = widened(pixel >> 5 & 63, 63);
        rgb[2] = widened(pixel & 31, 31);
    }
}

static void unpack_four(const uint8_t *packed, uint32_t red, uint32_t width, uint8_t *rgb)
{
    for (uint32_t x = 0; x < width; x++, packed += 4, rgb += 3) {
        rgb[0] = packed[red];
        rgb[1] = packed[1];
        rgb[2] = packed[2 - red];
    }
}

t3r_status t3r_unpack_row(t3r_packing packing, const uint8_t *packed, uint32_t width, uint8_t *rgb)
{
    T3R_PASS(t3r_packed_checks(packing, packed, rgb, width, NULL));
    if (packing <= T3R_PACKED_RGB565_BE) {
        unpack_rgb565(packed, packing == T3R_PACKED_RGB565_BE ? 0 : 1, width, rgb);
    } else {
        unpack_four(packed, packing == T3R_PACKED_BGRA ? 2 : 0, width, rgb);
    }
    return T3R_OK;
}
