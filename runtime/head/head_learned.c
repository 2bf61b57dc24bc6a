/* SPDX-License-Identifier: Apache-2.0 */
/* Converts a network's outputs at the retained pixels to footprints (SPEC.md, "Learned head"). */
#include "core/cut.h"
#include "core/fixed.h"
#include "head.h"
#include "head_features.h"
#include "network.h"

#define L_LEAST_Q12 580        /* least diagonal entry of the Cholesky factor: variance 0.02 px^2 */
#define L_MOST_Q12 (64 << 12)  /* bound of all its entries */
#define OPACITY_MOST_Q15 32440 /* 0.99 */
#define COLOUR_MOST_Q7 (255 << 7)

/* Returns the bytes of a row's outputs, the first part of the work; the network's follows. */
static size_t outputs_bytes(uint32_t width)
{
    return (size_t)width * T3R_HEAD_OUTPUTS * sizeof(int16_t);
}

static size_t with_outputs(size_t network, uint32_t width)
{
    const size_t row = T3R_UP_(outputs_bytes(width));
    return network > SIZE_MAX - T3R_ARENA_ALIGN - row ? SIZE_MAX : T3R_UP_(network) + row;
}

size_t t3r_head_learned_work_bytes(const void *weights, uint32_t width)
{
    return with_outputs(t3r_network_work_bytes(weights, width), width);
}

size_t t3r_head_learned_packed_bytes(const void *weights, uint32_t width)
{
    return with_outputs(t3r_network_packed_work_bytes(weights, width), width);
}

/* Converts x in units of 2^-shift spacings to pixels: |x| < 2^20 and spacing < 2^17. */
static int32_t in_pixels_q12(int32_t x, uint32_t spacing_q12, uint32_t shift)
{
    return (int32_t)t3r_round_shift64((int64_t)x * spacing_q12, shift);
}

static int32_t diagonal_q12(int16_t log_q13, uint32_t spacing_q12)
{
    int32_t ratio_q16 = (int32_t)t3r_exp2_q16(log_q13 * 8); /* 2^-4..2^4 */
    return t3r_clamp32(in_pixels_q12(ratio_q16, spacing_q12, 16), L_LEAST_Q12, L_MOST_Q12);
}

static t3r_footprint footprint_of(const int16_t out[T3R_HEAD_OUTPUTS], uint32_t spacing_q12, const t3r_view *view,
                                  size_t pixel)
{
    t3r_footprint f;
    f.offset_q12[0] = in_pixels_q12(out[T3R_OUT_OFFSET_X], spacing_q12, 14);
    f.offset_q12[1] = in_pixels_q12(out[T3R_OUT_OFFSET_Y], spacing_q12, 14);
    /* S = L L^T: products at most 2^36, their sum 2^37, Q24 */
    int64_t l11 = diagonal_q12(out[T3R_OUT_LOG_L11], spacing_q12);
    int64_t l22 = diagonal_q12(out[T3R_OUT_LOG_L22], spacing_q12);
    int64_t l21 = t3r_clamp32(in_pixels_q12(out[T3R_OUT_L21], spacing_q12, 14), -L_MOST_Q12, L_MOST_Q12);
    f.xx_q12 = (int32_t)t3r_round_shift64(l11 * l11, 12);
    f.xy_q12 = (int32_t)t3r_round_shift64(l11 * l21, 12);
    f.yy_q12 = (int32_t)t3r_round_shift64(l21 * l21 + l22 * l22, 12);
    f.opacity_q15 = (uint16_t)t3r_clamp32(out[T3R_OUT_OPACITY], 0, OPACITY_MOST_Q15);
    for (int c = 0; c < 3; c++) {
        int32_t own_q7 = view->colour[c][pixel] << 7;
        f.colour_q7[c] = (uint16_t)t3r_clamp32(own_q7 + out[T3R_OUT_RED + c], 0, COLOUR_MOST_Q7);
    }
    return f;
}

/* Predicts the outputs of row y's retained pixels: first even columns in blocks, then odd ones, because a block shares
 * one phase of a point layer's weights. */
static void predict_row(const t3r_head_input *input, const t3r_network *network, uint32_t y,
                        int16_t (*outputs)[T3R_HEAD_OUTPUTS])
{
    const t3r_view *view = input->map.view;
    for (uint32_t parity = 0; parity < 2; parity++) {
        uint32_t x[T3R_NETWORK_POINTS], count = 0;
        int8_t features[T3R_NETWORK_POINTS][T3R_FEATURES];
        for (uint32_t u = parity; u < view->width; u += 2) {
            if (t3r_retained(view, (size_t)y * view->width + u)) {
                t3r_head_features_at(input, u, y, features[count]);
                x[count++] = u;
            }
            if (count == T3R_NETWORK_POINTS || (count > 0 && u + 2 >= view->width)) {
                int16_t made[T3R_NETWORK_POINTS][T3R_HEAD_OUTPUTS];
                t3r_network_points(network, y, count, x, (const int8_t(*)[T3R_FEATURES])features, made);
                for (uint32_t i = 0; i < count; i++) {
                    for (int o = 0; o < T3R_HEAD_OUTPUTS; o++) {
                        outputs[x[i]][o] = made[i][o];
                    }
                }
                count = 0;
            }
        }
    }
}

static uint32_t lift_row(const t3r_head_input *input, uint32_t y, const int16_t (*outputs)[T3R_HEAD_OUTPUTS],
                         t3r_gaussian *out)
{
    const t3r_view *view = input->map.view;
    uint32_t count = 0;
    for (uint32_t x = 0; x < view->width; x++) {
        size_t pixel = (size_t)y * view->width + x;
        if (t3r_retained(view, pixel)) {
            t3r_footprint footprint = footprint_of(outputs[x], t3r_spacing_q12(input, pixel), view, pixel);
            t3r_lift(input, x, y, &footprint, &out[count++]);
        }
    }
    return count;
}

uint32_t t3r_head_learned(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out)
{
    const t3r_view *view = input->map.view;
    t3r_cut cut = t3r_cut_of(input->work, input->work_bytes);
    int16_t(*outputs)[T3R_HEAD_OUTPUTS] = t3r_take(&cut, outputs_bytes(view->width));
    t3r_network network;
    t3r_network_begin(&network, input->kernels, input->weights, view->width, view->height, begin, cut.at,
                      t3r_cut_left(&cut));
    uint32_t count = 0;
    for (int32_t y = t3r_network_first(&network); y < (int32_t)end; y++) {
        if (!t3r_head_goes_on(input)) {
            return T3R_HEAD_STOPPED;
        }
        while (t3r_network_wants_features(&network, y)) {
            uint32_t row;
            int8_t *features = t3r_network_feature_row(&network, &row);
            t3r_head_features(input, row, features);
        }
        t3r_network_step(&network, y);
        if (y >= (int32_t)begin) {
            predict_row(input, &network, (uint32_t)y, outputs);
            count += lift_row(input, (uint32_t)y, (const int16_t(*)[T3R_HEAD_OUTPUTS])outputs, out + count);
        }
    }
    return count;
}
