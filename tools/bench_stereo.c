#include "bench_stereo.h"

#include "state.h"
#include "stereo_views.h"

bool bench_stereo_run(t3r_runtime *runtime)
{
    t3r_view views[T3R_MAX_VIEWS];
    t3r_views_of(runtime, views);
    return t3r_stereo_views(runtime, views) == T3R_OK;
}
