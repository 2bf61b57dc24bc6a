/* SPDX-License-Identifier: Apache-2.0 */
#include "core/fixed.h"
#include "head.h"
#include "raster/raster_splat.h"

#define DILATION_Q12 ((T3R_DILATION_Q24 + 2048) >> 12) /* variance that the rasterizer adds */
/* Thickness along the normal relative to the narrower in-plane deviation, as a power of two: 1/8 */
#define THICKNESS_SHIFT 3

uint32_t t3r_spacing_q12(const t3r_head_input *input, size_t pixel)
{
    if (input->unadapted) {
        return 1 << 12;
    }
    int32_t density_q10 = t3r_log_density_q10(input->map.view, pixel, input->settings, input->clusters);
    return t3r_exp2_q16(-density_q10 * 32) >> 4; /* 2^(-density / 2), Q12 */
}

/* Computes the lower Cholesky factor of S - 0.3 I, Q12 pixels, both pivots at least `least`. */
static void narrowed_factor(const t3r_footprint *f, int64_t least_q12, int64_t lower_q12[3])
{
    int64_t xx = T3R_MAX(f->xx_q12 - DILATION_Q12, least_q12);
    int64_t yy = T3R_MAX(f->yy_q12 - DILATION_Q12, least_q12);
    lower_q12[0] = t3r_isqrt64((uint64_t)xx << 12);
    lower_q12[1] = ((int64_t)f->xy_q12 * 4096) / lower_q12[0];
    int64_t rest_q24 = (yy << 12) - lower_q12[1] * lower_q12[1];
    lower_q12[2] = t3r_isqrt64((uint64_t)T3R_MAX(rest_q24, least_q12 << 12));
}

void t3r_pack_factor(const int64_t entry[9], int32_t fraction, t3r_gaussian *gaussian)
{
    uint64_t most = 1;
    for (int i = 0; i < 9; i++) {
        most = T3R_MAX(most, (uint64_t)t3r_abs64(entry[i]));
    }
    int32_t shift = (int32_t)t3r_msb64(most) - 13; /* rounding may carry into the 15th bit, never the 16th */
    for (int i = 0; i < 9; i++) {
        gaussian->factor[i] = (int16_t)t3r_scale64(entry[i], -shift);
    }
    gaussian->factor_exponent = (int8_t)t3r_clamp32(shift - fraction, -60, 15);
}

void t3r_lift(const t3r_head_input *input, uint32_t u, uint32_t v, const t3r_footprint *footprint,
              t3r_gaussian *gaussian)
{
    const t3r_pointmap *map = &input->map;
    const t3r_view *view = map->view;
    int32_t point[3], tu[3], tv[3];
    (void)t3r_point(map, u, v, point);
    (void)t3r_tangents(map, u, v, tu, tv);
    int64_t lower[3];
    narrowed_factor(footprint, input->narrowest_q12, lower);

    /* Columns [tu tv] L, Q24 scene units: |t| < 2^31 and |L| < 2^12 px in Q12, so the products stay below 2^56. */
    int64_t entry[9];
    int64_t square[2] = {0, 0};
    for (int i = 0; i < 3; i++) {
        entry[3 * i] = t3r_round_shift64(tu[i] * lower[0] + tv[i] * lower[1], 12);
        entry[3 * i + 1] = t3r_round_shift64(tv[i] * lower[2], 12);
    }
    /* normal from mantissas of 15 bits: cross products below 2^31 */
    uint64_t most = 1;
    for (int i = 0; i < 3; i++) {
        most = T3R_MAX(most, (uint64_t)T3R_MAX(t3r_abs64(entry[3 * i]), t3r_abs64(entry[3 * i + 1])));
    }
    int32_t reduce = T3R_MAX(0, (int32_t)t3r_msb64(most) - 14);
    int64_t a[3], b[3], normal[3];
    for (int i = 0; i < 3; i++) {
        a[i] = t3r_scale64(entry[3 * i], -reduce);
        b[i] = t3r_scale64(entry[3 * i + 1], -reduce);
        square[0] += a[i] * a[i];
        square[1] += b[i] * b[i];
    }
    uint64_t length_square = 0;
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        normal[i] = a[j] * b[k] - a[k] * b[j];
        length_square += (uint64_t)(normal[i] * normal[i]) >> 2; /* three of 2^62 / 4 */
    }
    int64_t length = 2 * (int64_t)t3r_isqrt64(length_square);
    int64_t thickness = (int64_t)t3r_isqrt64((uint64_t)T3R_MIN(square[0], square[1])) << reduce >> THICKNESS_SHIFT;
    for (int i = 0; i < 3; i++) {
        entry[3 * i + 2] = length == 0 ? 0 : t3r_round_shift64(normal[i] * (1 << 16) / length * thickness, 16);
    }
    t3r_pack_factor(entry, 24, gaussian);

    for (int i = 0; i < 3; i++) {
        int64_t moved = tu[i] * (int64_t)footprint->offset_q12[0] + tv[i] * (int64_t)footprint->offset_q12[1];
        int64_t x = point[i] + t3r_round_shift64(moved, 16); /* Q24 x Q12 to Q20 */
        gaussian->position_q20[i] = (int32_t)t3r_clamp64(x, -T3R_POSITION_MOST_Q20, T3R_POSITION_MOST_Q20);
        gaussian->colour_q7[i] = footprint->colour_q7[i];
        gaussian->reserved[i] = 0;
    }
    gaussian->opacity_q15 = footprint->opacity_q15;
    gaussian->view = (uint8_t)input->view_index;
    gaussian->confidence = t3r_confidence_of(view->validity[(size_t)v * view->width + u]);
}
