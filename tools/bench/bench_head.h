/* The head stage alone, on views that have been analysed. */
#ifndef TRIM3R_TOOLS_BENCH_HEAD_H
#define TRIM3R_TOOLS_BENCH_HEAD_H

#include <stdbool.h>

#include "trim3r.h"

/* Runs the learned head again over the views of the scene in `runtime`. Its configuration must have the head `learned`,
 * bound, and keep_analysis; nothing may have been drawn since. Returns false unless it gives as many Gaussians as the
 * scene has. */
bool bench_head_run(t3r_runtime *runtime);

/* Returns the multiply-accumulates of that with every pixel of `views` views of width x height retained. */
double bench_head_macs(const void *weights, uint32_t width, uint32_t height, uint32_t views);

#endif
