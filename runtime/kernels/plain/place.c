/* SPDX-License-Identifier: Apache-2.0 */
#include "kernels/place.h"

#include <stdbool.h>

#include "core/features.h"
#include "core/fixed.h"

/* A quadratic that is nowhere below this draws nothing: 255 exp(-6) < 1. */
#define LEVEL_MOST 6

/* Returns the least of q + 2 h t + a t^2 for t in [0, length], all Q18 except the length in pixels. */
static int64_t least_along(int64_t q, int64_t h, int64_t a, int64_t length)
{
    int64_t t_q8 = h >= 0 ? 0 : length << 8;
    if (h < 0 && a > 0) {
        t_q8 = T3R_MIN((-h * 256) / a, t_q8);
    }
    return q + ((h * t_q8) >> 7) + ((a * t_q8 * t_q8) >> 16);
}

/* Whether the quadratic of a splat centred elsewhere falls below LEVEL_MOST on any of eight columns of a tile (pixel
 * centres), whose first pixel is left and top of the centre in Q12. It is convex, so its least value there is on an
 * edge. Within its box a splat is at most 2^14.6 px away: half-gradients below 2^16 and products below 2^61 in Q18 x
 * Q12. */
static inline __attribute__((always_inline)) bool touches(const t3r_splat *s, int64_t left, int64_t top,
                                                          uint32_t spread)
{
    const int64_t width = (T3R_LANES - 1) << spread, height = (T3R_TILE_SIDE - 1) << spread;
    int64_t right = left + (width << 12), bottom = top + (height << 12);
    int64_t a = s->a_q30 >> 12, c = s->c_q30 >> 12;
    const int64_t most = (int64_t)LEVEL_MOST << 18;
    for (int corner = 0; corner < 2; corner++) { /* top left, then bottom right */
        int64_t dx = corner == 0 ? left : right, dy = corner == 0 ? top : bottom;
        int64_t hx = (s->a_q30 * dx + s->b_q30 * dy) >> 24, hy = (s->b_q30 * dx + s->c_q30 * dy) >> 24;
        int64_t q = (hx * dx + hy * dy) >> 12;
        int64_t sign = corner == 0 ? 1 : -1;
        if (q < most || least_along(q, sign * hx, a, width) < most || least_along(q, sign * hy, c, height) < most) {
            return true;
        }
    }
    return false;
}

/* Computes the quadratic from the group's first pixel, dx and dy from the centre. If the columns are touched it is
 * below 2,100 there (the root of 6 plus the group's diagonal in the steepest metric, squared), so half-gradients are
 * below 2^5.9. The centre is less than 2^14.6 px away: the two products of q sum to less than 2^62.8. */
static void place_group(const t3r_splat *s, int64_t dx, int64_t dy, uint32_t group, t3r_tile_splat *out)
{
    int64_t hx_q30 = t3r_round_shift64(s->a_q30 * dx + s->b_q30 * dy, 12);
    int64_t hy_q30 = t3r_round_shift64(s->b_q30 * dx + s->c_q30 * dy, 12);
    out->group[group].q = (int32_t)t3r_round_shift64(hx_q30 * dx + hy_q30 * dy, 25);
    out->group[group].gx = (int32_t)t3r_round_shift64(hx_q30, 12);
    out->group[group].gy = (int32_t)t3r_round_shift64(hy_q30, 12);
}

/* Takes gradients and curvatures from pixel to pixel of the picture, 2^spread of the camera's apart. */
static void spread_out(uint32_t spread, t3r_tile_splat *out)
{
    const int32_t one = 1 << spread, square = one * one;
    for (uint32_t group = 0; group < out->groups; group++) {
        if ((out->drawn >> group & 1) != 0) {
            out->group[group].gx *= one;
            out->group[group].gy *= one;
        }
    }
    out->a *= square;
    out->b *= square;
    out->c *= square;
}

/* Whether a centre lies near the tile along one axis: the tile's first pixel is `offset` from there. */
static inline bool is_near(int32_t offset_q12, uint32_t spread)
{
    return offset_q12 <= t3r_near_q12(spread) && offset_q12 >= -T3R_NEAR_MOST_Q12;
}

void t3r_splat_span(const t3r_splat *s, uint32_t left, uint32_t top, t3r_tile_splat *out)
{
    const uint32_t x0 = T3R_MAX(s->x0, left) - left, x1 = T3R_MIN(s->x1, left + T3R_TILE_SIDE - 1) - left;
    const bool wide = x1 - x0 >= T3R_LANES;
    for (int i = 0; i < 3; i++) {
        out->colour_q7[i] = s->colour_q7[i];
    }
    out->column = (uint8_t)(wide ? 0 : T3R_MIN(x0, (uint32_t)T3R_TILE_SIDE - T3R_LANES));
    out->groups = wide ? T3R_TILE_GROUPS : 1;
    out->first = (uint8_t)(T3R_MAX(s->y0, top) - top);
    out->last = (uint8_t)(T3R_MIN(s->y1, top + T3R_TILE_SIDE - 1) - top);
    out->x0 = (uint8_t)x0;
    out->x1 = (uint8_t)x1;
}

/* spread: that of the tile; a constant once inlined. */
static inline __attribute__((always_inline)) void place_at(const t3r_splat *s, const t3r_tile_place *tile,
                                                           uint32_t spread, t3r_tile_splat *out)
{
    const int32_t left = tile->left_q12 - s->x_q12, top = tile->top_q12 - s->y_q12; /* below 2^27 */
    const bool small = is_near(left, spread) && is_near(top, spread);
    t3r_splat_span(s, tile->left, tile->top, out);
    out->a = t3r_round_shift32(s->a_q30 >> 1, 12);
    out->b = (int32_t)t3r_round_shift64(s->b_q30, 12);
    out->c = t3r_round_shift32(s->c_q30 >> 1, 12);
    out->opacity_q16 = (uint16_t)(2 * s->opacity_q15);
    out->drawn = 0;
    for (uint32_t group = 0; group < out->groups; group++) {
        const int32_t dx = left + (int32_t)((out->column + group * T3R_LANES) << (12 + spread));
        if (small || touches(s, dx, top, spread)) {
            place_group(s, dx, top, group, out);
            out->drawn |= (uint8_t)(1 << group);
        }
    }
    if (spread > 0) {
        spread_out(spread, out);
    }
}

void t3r_place(const t3r_splat *s, const t3r_tile_place *tile, t3r_tile_splat *out)
{
    if (!T3R_FEATURE_PARTS || tile->spread == 0) {
        place_at(s, tile, 0, out);
    } else {
        place_at(s, tile, 1, out);
    }
}

void t3r_place_c(const t3r_splat *splats, const uint32_t *list, uint32_t count, const t3r_tile_place *tile,
                 t3r_tile_splat *placed)
{
    for (uint32_t i = 0; i < count; i++) {
        t3r_place(&splats[list[i]], tile, &placed[i]);
    }
}
