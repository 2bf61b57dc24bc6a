/* SPDX-License-Identifier: Apache-2.0 */
#include "head_features.h"

#include "core/fixed.h"

#define LOG_DENSITY_NONE (-70)
#define TEXTURE_FLOOR_Q4 8
#define TEXTURE_MIDDLE_Q16 622592 /* 9.5 */
#define SLOPE_GAIN 4064
#define MEASURED 127
#define FILLED 64

static int8_t held(int32_t x)
{
    return (int8_t)t3r_clamp32(x, -127, 127);
}

/* Returns (after - before) / (2 here) x SLOPE_GAIN. At the border the pixel replaces the missing neighbour. */
static int8_t slope(uint16_t before, uint16_t here, uint16_t after)
{
    if (before == 0 || here == 0 || after == 0) {
        return 0;
    }
    const int32_t rise = ((int32_t)after - before) * SLOPE_GAIN; /* below 2^28 */
    return held(t3r_round_div32(rise, 2 * (int32_t)here));
}

void t3r_head_features_at(const t3r_head_input *input, uint32_t x, uint32_t y, int8_t features[T3R_FEATURES])
{
    const t3r_view *view = input->map.view;
    const uint32_t w = view->width;
    const size_t i = (size_t)y * w + x;
    for (int c = 0; c < 3; c++) {
        features[c] = (int8_t)(view->colour[c][i] - 128);
    }
    const bool has_depth = t3r_has_depth(view->validity[i]);
    bool retained = input->unadapted ? has_depth : t3r_retained(view, i);
    features[3] = retained ? 127 : 0;
    features[4] = 0;
    features[5] = LOG_DENSITY_NONE;
    features[6] = features[7] = features[8] = 0;
    if (!has_depth || (!retained && t3r_is_deferred(view, i, input->settings))) {
        return; /* a deferred point need not be covered */
    }
    features[4] = t3r_is_measured(view->validity[i]) ? MEASURED : FILLED;
    const uint16_t *depth = view->depth + i;
    int32_t density_q10 = input->unadapted ? 0 : t3r_log_density_q10(view, i, input->settings, input->clusters);
    features[5] = held(t3r_round_shift32(density_q10, 6) + 64);
    features[6] =
        held(t3r_round_shift32(t3r_log2_q16((uint32_t)view->texture[i] + TEXTURE_FLOOR_Q4) - TEXTURE_MIDDLE_Q16, 12));
    features[7] = slope(depth[x > 0 ? -1 : 0], *depth, depth[x + 1 < w ? 1 : 0]);
    features[8] = slope(depth[y > 0 ? -(ptrdiff_t)w : 0], *depth, depth[y + 1 < view->height ? w : 0]);
}

void t3r_head_features(const t3r_head_input *input, uint32_t y, int8_t *row)
{
    for (uint32_t x = 0; x < input->map.view->width; x++) {
        t3r_head_features_at(input, x, y, row + (size_t)x * T3R_FEATURES);
    }
}
