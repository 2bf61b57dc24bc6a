/* SPDX-License-Identifier: Apache-2.0 */
/* A row of a Bayer pattern to R G B. */
#include <stdbool.h>

#include "row_checks.h"

static uint8_t mean_of_2(uint32_t a, uint32_t b)
{
    return (uint8_t)((a + b + 1) / 2);
}

static uint8_t mean_of_4(uint32_t a, uint32_t b, uint32_t c, uint32_t d)
{
    return (uint8_t)((a + b + c + d + 2) / 4);
}

t3r_status t3r_demosaic_row(t3r_bayer order, uint32_t y, const uint8_t *above, const uint8_t *row, const uint8_t *below,
                            uint32_t width, uint8_t *rgb)
{
    T3R_PASS(t3r_demosaic_checks(order, above, row, below, width, rgb, NULL));
    /* the bits of `order` are the column and the row of red in its square of 2 x 2 */
    const bool has_red = (y & 1) == order >> 1;
    const uint32_t own = has_red ? 0 : 2; /* the colour of this row beside green; the rows above and below have the
                                           * other one */
    for (uint32_t x = 0; x < width; x++, rgb += 3) {
        const uint32_t left = x == 0 ? 1 : x - 1, right = x + 1 == width ? width - 2 : x + 1;
        const bool is_green = ((x & 1) == (order & 1)) != has_red;
        if (is_green) {
            rgb[own] = mean_of_2(row[left], row[right]);
            rgb[1] = row[x];
            rgb[2 - own] = mean_of_2(above[x], below[x]);
        } else {
            rgb[own] = row[x];
            rgb[1] = mean_of_4(row[left], row[right], above[x], below[x]);
            rgb[2 - own] = mean_of_4(above[left], above[right], below[left], below[right]);
        }
    }
    return T3R_OK;
}
