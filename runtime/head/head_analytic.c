/* SPDX-License-Identifier: Apache-2.0 */
/* A head without weights: a disc on the surface, sigma 0.6 of the spacing of its kept neighbours, coloured by the mean
 * of the pixels it represents. */
#include "core/fixed.h"
#include "depth/depth.h"
#include "fitted_widths.h"
#include "head.h"

#define SIGMA_SQUARE_Q12 1475 /* 0.6^2, tuned on the training scenes */
#define WINDOW_MOST 7

/* Computes the mean colour of the pixels on the same surface within +-half pixels; Q7. At most 225 x 255 a sum. */
static void local_mean(const t3r_view *view, uint32_t u, uint32_t v, uint32_t half, uint16_t colour_q7[3])
{
    uint32_t x0 = u > half ? u - half : 0, x1 = T3R_MIN(u + half, view->width - 1);
    uint32_t y0 = v > half ? v - half : 0, y1 = T3R_MIN(v + half, view->height - 1);
    uint16_t depth = view->depth[(size_t)v * view->width + u];
    uint32_t sum[3] = {0, 0, 0}, count = 0;
    for (uint32_t y = y0; y <= y1; y++) {
        for (uint32_t x = x0; x <= x1; x++) {
            size_t i = (size_t)y * view->width + x;
            if (t3r_has_depth(view->validity[i]) && t3r_same_surface(depth, view->depth[i])) {
                for (int c = 0; c < 3; c++) {
                    sum[c] += view->colour[c][i];
                }
                count++;
            }
        }
    }
    for (int c = 0; c < 3; c++) {
        /* The pixel itself counts: count >= 1. NOLINTNEXTLINE(clang-analyzer-core.DivideZero) */
        colour_q7[c] = (uint16_t)(((sum[c] << 7) + count / 2) / count);
    }
}

uint32_t t3r_head_analytic(const t3r_head_input *input, uint32_t begin, uint32_t end, t3r_gaussian *out)
{
    const t3r_view *view = input->map.view;
    uint32_t count = 0;
    for (uint32_t v = begin; v < end; v++) {
        if (!t3r_head_goes_on(input)) {
            return T3R_HEAD_STOPPED;
        }
        for (uint32_t u = 0; u < view->width; u++) {
            size_t pixel = (size_t)v * view->width + u;
            if (!t3r_retained(view, pixel)) {
                continue;
            }
            uint32_t spacing = t3r_spacing_q12(input, pixel); /* below 20 px */
            uint32_t square = (uint32_t)(((uint64_t)spacing * spacing) >> 12);
            t3r_footprint footprint = {.opacity_q15 = T3R_HEAD_OPACITY_Q15};
            footprint.xx_q12 = footprint.yy_q12 = (int32_t)(((uint64_t)square * SIGMA_SQUARE_Q12 + 2048) >> 12);
            uint32_t half = T3R_MIN(spacing >> 13, (uint32_t)WINDOW_MOST);
            local_mean(view, u, v, half, footprint.colour_q7);
            t3r_fit_widths_if_asked(input, u, v, &footprint);
            t3r_lift(input, u, v, &footprint, &out[count++]);
        }
    }
    return count;
}
