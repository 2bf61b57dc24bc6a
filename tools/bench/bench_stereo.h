/* Stereo matching alone, on views that have been analysed. */
#ifndef TRIM3R_TOOLS_BENCH_STEREO_H
#define TRIM3R_TOOLS_BENCH_STEREO_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

/* Computes the depth of all views by stereo again, from their colours. The configuration must have keep_analysis and
 * depth by stereo; nothing may have been drawn since the analysis, which is unusable afterwards. */
bool bench_stereo_run(t3r_runtime *runtime);

/* The same for its first two views, with 4 or 8 paths, whatever the pipeline uses; `work` has bench_stereo_bytes(). */
bool bench_stereo_paths_run(t3r_runtime *runtime, uint32_t paths, void *work);

/* Returns the bytes for views of that size, to be aligned to 64. */
size_t bench_stereo_bytes(uint32_t width, uint32_t height, uint32_t paths);

#endif
