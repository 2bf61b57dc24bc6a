/* One refinement pass alone, on views that have been analysed. */
#ifndef TRIM3R_TOOLS_BENCH_REFINE_H
#define TRIM3R_TOOLS_BENCH_REFINE_H

#include <stdbool.h>

#include "trim3r.h"

/* Replaces the scene by `scene` (as many Gaussians as the runtime's scene has) and refines it by one pass over all
 * views. The configuration must have one refinement and keep_analysis; nothing may have been drawn since the
 * analysis. */
bool bench_refine_run(t3r_runtime *runtime, const t3r_gaussian *scene);

#endif
