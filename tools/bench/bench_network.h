/* The learned head's network alone, without its features and without lifting, on views that were analysed before. */
#ifndef TRIM3R_TOOLS_BENCH_NETWORK_H
#define TRIM3R_TOOLS_BENCH_NETWORK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

/* Bytes of the features of all views, and those features, made once. The scene in `runtime` has the head `learned` and
 * keep_analysis and the head is bound; nothing may have been drawn since. */
size_t bench_network_bytes(const t3r_runtime *runtime);
void bench_network_features(const t3r_runtime *runtime, int8_t *features);

/* Runs the network over all views and at their retained points. False unless those are as many as the scene's. */
bool bench_network_run(const t3r_runtime *runtime, const int8_t *features);

#endif
