/* One refinement pass alone, on views that were analysed before. */
#ifndef TRIM3R_TOOLS_BENCH_REFINE_H
#define TRIM3R_TOOLS_BENCH_REFINE_H

#include <stdbool.h>

#include "trim3r.h"

/* Puts `scene` (as many Gaussians as the runtime's scene has) in place of the scene and refines it by one pass over all
 * views. The configuration has one refinement and keep_analysis; nothing may have been drawn since the analysis. */
bool bench_refine_run(t3r_runtime *runtime, const t3r_gaussian *scene);

#endif
