/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/bench_head.h"

#include "head/head.h"
#include "head/head_views.h"
#include "head/weights.h"
#include "stages.h"
#include "state/state.h"

bool bench_head_run(t3r_runtime *runtime)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_gaussian *scene = t3r_buffer_at(runtime, T3R_BUFFER_SCENE);
    uint32_t count = 0;
    t3r_views_of(runtime, views);
    const t3r_budget_settings settings = t3r_budget_settings_of(runtime, views);
    for (uint32_t v = 0; v < runtime->views; v++) {
        const t3r_head_input input = t3r_head_input_of(runtime, views, v, &settings);
        count += t3r_head_learned(&input, 0, input.map.view->height, scene + count);
    }
    return count == settings.gaussians;
}

double bench_head_macs(const void *weights, uint32_t width, uint32_t height, uint32_t views)
{
    return t3r_weights_header_of(weights).macs_q8 / 256.0 * width * height * views;
}
