/* SPDX-License-Identifier: Apache-2.0 */
/* R G B to the pixels of a display. */
#include "row_checks.h"

#define ALPHA_ONE 32767u

/* Returns a level of 0..255 as one of 0..most, rounded to nearest. */
static uint32_t narrowed(uint8_t level, uint32_t most)
{
    return (level * most + 127) / 255;
}

static void pack_rgb565(const uint8_t *rgb, uint32_t high, uint32_t width, uint8_t *packed)
{
    for (uint32_t x = 0; x < width; x++, rgb += 3, packed += 2) {
        const uint32_t pixel = narrowed(rgb[0], 31) << 11 | narrowed(rgb[1], 63) << 5 | narrowed(rgb[2], 31);
        packed[high] = (uint8_t)(pixel >> 8);
        packed[1 - high] = (uint8_t)pixel;
    }
}

static void pack_four(const uint8_t *rgb, const uint16_t *alpha_q15, uint32_t red, uint32_t width, uint8_t *packed)
{
    for (uint32_t x = 0; x < width; x++, rgb += 3, packed += 4) {
        packed[red] = rgb[0];
        packed[1] = rgb[1];
        packed[2 - red] = rgb[2];
        packed[3] = alpha_q15 == NULL ? 255 : (uint8_t)((alpha_q15[x] * 255u + ALPHA_ONE / 2) / ALPHA_ONE);
    }
}

t3r_status t3r_pack_row(t3r_packing packing, const uint8_t *rgb, const uint16_t *alpha_q15, uint32_t width,
                        uint8_t *packed)
{
    T3R_PASS(t3r_packed_checks(packing, rgb, packed, width, NULL));
    if (packing <= T3R_PACKED_RGB565_BE) {
        pack_rgb565(rgb, packing == T3R_PACKED_RGB565_BE ? 0 : 1, width, packed);
    } else {
        pack_four(rgb, alpha_q15, packing == T3R_PACKED_BGRA ? 2 : 0, width, packed);
    }
    return T3R_OK;
}
