/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/bench_refine.h"

#include <string.h>

#include "refine/refine.h"
#include "state/state.h"

bool bench_refine_run(t3r_runtime *runtime, const t3r_gaussian *scene)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(runtime, views);
    memcpy(t3r_buffer_at(runtime, T3R_BUFFER_SCENE), scene, runtime->gaussians * sizeof *scene);
    return t3r_refine(runtime, views, (t3r_passes){1, 0}) == T3R_OK;
}
