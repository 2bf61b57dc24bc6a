/* SPDX-License-Identifier: Apache-2.0 */
/* A view over a background. */
#include "core/fixed.h"
#include "row_checks.h"

#define ALPHA_ONE 32767u

t3r_status t3r_composite_row(uint8_t *rgb, const uint16_t *alpha_q15, uint32_t width, const uint8_t background[3])
{
    T3R_PASS(t3r_composite_checks(rgb, alpha_q15, width, background, NULL));
    for (uint32_t x = 0; x < width; x++, rgb += 3) {
        const uint32_t shown = ALPHA_ONE - T3R_MIN(alpha_q15[x], ALPHA_ONE);
        for (uint32_t c = 0; c < 3; c++) {
            /* the view's own rounding may exceed its alpha by a level */
            const uint32_t level = rgb[c] + (background[c] * shown + ALPHA_ONE / 2) / ALPHA_ONE;
            rgb[c] = (uint8_t)T3R_MIN(level, 255);
        }
    }
    return T3R_OK;
}
