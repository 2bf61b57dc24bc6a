/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_outline.h"

#include "core/fixed.h"

/* Distance up to which paths carry an outline's influence */
#define REACH 16
/* Distances that differ by at most this are equal. */
#define EQUAL 3

/* Returns the number of pixels with content from column x on in a direction, up to REACH. Beyond the plane's own end
 * counts as content, as in the census. */
static int32_t shown(const uint8_t *luma, int32_t width, int32_t x, int32_t direction)
{
    for (int32_t n = 1; n < REACH; n++) {
        const int32_t at = x + n * direction;
        if (at < 0 || at >= width) {
            return REACH;
        }
        if (luma[at] == 0) {
            return n;
        }
    }
    return REACH;
}

/* Returns the first column without content from x on, REACH beyond the plane if there is none. */
static int32_t end_from(const uint8_t *luma, int32_t width, int32_t x)
{
    while (x < width && luma[x] != 0) {
        x++;
    }
    return x < width ? x : width + REACH;
}

/* Whether the other plane's column x is as far from the end of content as a column that shows `own` pixels. */
static bool ends_alike(int32_t own, const uint8_t *luma, int32_t width, int32_t x, int32_t direction)
{
    if (own == REACH) {
        return false;
    }
    const int32_t other = shown(luma, width, x, direction);
    return other < REACH && t3r_abs32(own - other) <= EQUAL;
}

/* Removes the confidence of pixels of row y in one plane. */
static void leave_out(const t3r_match *match, uint32_t y, uint32_t side)
{
    const int32_t widths[2] = {(int32_t)match->width, (int32_t)T3R_MATCH_RIGHT(match->width, match->disparities)};
    const int32_t width = widths[side], other_width = widths[1 - side];
    const uint8_t *luma = match->luma[side] + (size_t)y * (size_t)width;
    const uint8_t *other = match->luma[1 - side] + (size_t)y * (size_t)other_width;
    const uint16_t *disparity = match->disparity[side] + (size_t)y * (size_t)width;
    uint8_t *confidence = match->confidence[side] + (size_t)y * (size_t)width;
    int32_t left = REACH, end = 0; /* pixels shown to the left; first end to the right */
    for (int32_t x = 0; x < width; x++) {
        end = end > x ? end : end_from(luma, width, x + 1);
        if (confidence[x] != 0) {
            /* the partner is in the plane, because both disparities agree */
            const int32_t shift = (int32_t)match->disparities - 1 - t3r_round_shift32(disparity[x], T3R_DISPARITY_BITS);
            const int32_t partner = side == 0 ? x + shift : x - shift;
            if (ends_alike(left, other, other_width, partner, -1) ||
                ends_alike(T3R_MIN(end - x, REACH), other, other_width, partner, 1)) {
                confidence[x] = 0;
            }
        }
        left = luma[x] == 0 ? 1 : T3R_MIN(left + 1, REACH);
    }
}

void t3r_plane_outline(const t3r_match *match)
{
    for (uint32_t y = 0; y < match->height; y++) {
        for (uint32_t side = 0; side < 2; side++) {
            leave_out(match, y, side);
        }
    }
}
