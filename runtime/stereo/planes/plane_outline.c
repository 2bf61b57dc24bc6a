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

/* Whether two columns are equally far from the end of content on one side. */
static bool ends_alike(const uint8_t *const luma[2], const int32_t width[2], const int32_t x[2], int32_t direction)
{
    const int32_t own = shown(luma[0], width[0], x[0], direction);
    if (own == REACH) {
        return false;
    }
    const int32_t other = shown(luma[1], width[1], x[1], direction);
    return other < REACH && t3r_abs32(own - other) <= EQUAL;
}

void t3r_plane_outline(const t3r_match *match)
{
    const int32_t widths[2] = {(int32_t)match->width, (int32_t)T3R_MATCH_RIGHT(match->width, match->disparities)};
    for (uint32_t y = 0; y < match->height; y++) {
        for (uint32_t side = 0; side < 2; side++) {
            const uint32_t sides[2] = {side, 1 - side};
            const int32_t width[2] = {widths[side], widths[1 - side]};
            const uint8_t *const luma[2] = {match->luma[side] + (size_t)y * (size_t)width[0],
                                            match->luma[1 - side] + (size_t)y * (size_t)width[1]};
            const uint16_t *disparity = match->disparity[sides[0]] + (size_t)y * (size_t)width[0];
            uint8_t *confidence = match->confidence[side] + (size_t)y * (size_t)width[0];
            for (int32_t x = 0; x < width[0]; x++) {
                if (confidence[x] == 0) {
                    continue;
                }
                const int32_t shift =
                    (int32_t)match->disparities - 1 - t3r_round_shift32(disparity[x], T3R_DISPARITY_BITS);
                const int32_t columns[2] = {
                    x, side == 0 ? x + shift
                                 : x - shift}; /* the partner is in the plane, because both disparities agree */
                if (ends_alike(luma, width, columns, -1) || ends_alike(luma, width, columns, 1)) {
                    confidence[x] = 0;
                }
            }
        }
    }
}
