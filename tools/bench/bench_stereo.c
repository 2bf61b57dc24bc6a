/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/bench_stereo.h"

#include "state/state.h"
#include "stereo/planes/plane_fill.h"
#include "stereo/stereo.h"
#include "stereo/stereo_views.h"

bool bench_stereo_run(t3r_runtime *runtime)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(runtime, views);
    return t3r_stereo_views(runtime, views) == T3R_OK;
}

size_t bench_stereo_bytes(uint32_t width, uint32_t height, uint32_t paths)
{
    size_t pair = T3R_STEREO_WORK_BYTES(width, height, T3R_STEREO_DISPARITIES, paths);
    size_t fill = T3R_PLANE_FILL_BYTES(width, height);
    return pair > fill ? pair : fill;
}

bool bench_stereo_paths_run(t3r_runtime *runtime, uint32_t paths, void *work)
{
    const t3r_stereo_settings settings = {
        .kernels = &runtime->kernels,
        .disparities = T3R_STEREO_DISPARITIES,
        .paths = paths,
        .fill = 0,
        .workers = t3r_workers_of(runtime),
    };
    t3r_view views[T3R_MAX_VIEWS];
    uint64_t unit_q40;
    t3r_views_of(runtime, views);
    if (t3r_stereo_depth(&settings, runtime->camera, views, work, &unit_q40) != T3R_PAIR_OK) {
        return false;
    }
    for (uint32_t v = 0; v < 2; v++) {
        t3r_stereo_finish(runtime, views, v, 1 - v, work);
    }
    return true;
}
