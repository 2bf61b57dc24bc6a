/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/bench_network.h"

#include <string.h>

#include "head/head_features.h"
#include "head/head_views.h"
#include "head/network.h"
#include "stages.h"
#include "state/state.h"

static size_t view_bytes(const t3r_view *view)
{
    return (size_t)view->width * view->height * T3R_FEATURES;
}

size_t bench_network_bytes(const t3r_runtime *runtime)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(runtime, views);
    return runtime->views * view_bytes(&views[0]);
}

void bench_network_features(const t3r_runtime *runtime, int8_t *features)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(runtime, views);
    const t3r_budget_settings settings = t3r_budget_settings_of(runtime, views);
    for (uint32_t v = 0; v < runtime->views; v++) {
        const t3r_head_input input = t3r_head_input_of(runtime, views, v, &settings);
        for (uint32_t y = 0; y < views[v].height; y++, features += (size_t)views[v].width * T3R_FEATURES) {
            t3r_head_features(&input, y, features);
        }
    }
}

/* Runs the network at the retained points of a row. Returns their number. */
static uint32_t run_points(const t3r_network *network, const t3r_view *view, uint32_t y, const int8_t *row)
{
    uint32_t points = 0;
    for (uint32_t parity = 0; parity < 2; parity++) {
        uint32_t x[T3R_NETWORK_POINTS], count = 0;
        int8_t own[T3R_NETWORK_POINTS][T3R_FEATURES];
        int16_t made[T3R_NETWORK_POINTS][T3R_HEAD_OUTPUTS];
        for (uint32_t u = parity; u < view->width; u += 2) {
            if (t3r_retained(view, (size_t)y * view->width + u)) {
                memcpy(own[count], row + (size_t)u * T3R_FEATURES, T3R_FEATURES);
                x[count++] = u;
            }
            if (count == T3R_NETWORK_POINTS || (count > 0 && u + 2 >= view->width)) {
                t3r_network_points(network, y, count, x, (const int8_t(*)[T3R_FEATURES])own, made);
                points += count;
                count = 0;
            }
        }
    }
    return points;
}

static uint32_t run_view(const t3r_head_input *input, const int8_t *features)
{
    const t3r_view *view = input->map.view;
    const size_t row_bytes = (size_t)view->width * T3R_FEATURES;
    t3r_network network;
    uint32_t points = 0;
    t3r_network_begin(&network, input->kernels, input->weights, view->width, view->height, 0, input->work,
                      input->work_bytes);
    for (int32_t y = t3r_network_first(&network); y < (int32_t)view->height; y++) {
        while (t3r_network_wants_features(&network, y)) {
            uint32_t row;
            int8_t *to = t3r_network_feature_row(&network, &row);
            memcpy(to, features + row * row_bytes, row_bytes);
        }
        t3r_network_step(&network, y);
        if (y >= 0) {
            points += run_points(&network, view, (uint32_t)y, features + (size_t)y * row_bytes);
        }
    }
    return points;
}

bool bench_network_run(const t3r_runtime *runtime, const int8_t *features)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(runtime, views);
    const t3r_budget_settings settings = t3r_budget_settings_of(runtime, views);
    uint32_t points = 0;
    for (uint32_t v = 0; v < runtime->views; v++, features += view_bytes(&views[0])) {
        const t3r_head_input input = t3r_head_input_of(runtime, views, v, &settings);
        points += run_view(&input, features);
    }
    return points == settings.gaussians;
}
