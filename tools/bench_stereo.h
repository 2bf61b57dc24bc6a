/* The matching of views alone, on views that were analysed before. */
#ifndef TRIM3R_TOOLS_BENCH_STEREO_H
#define TRIM3R_TOOLS_BENCH_STEREO_H

#include <stdbool.h>

#include "trim3r.h"

/* Depth of all views by stereo once more, from their colours. The configuration has keep_analysis and depth by stereo;
 * nothing may have been drawn since the analysis, which is of no use afterwards. */
bool bench_stereo_run(t3r_runtime *runtime);

#endif
