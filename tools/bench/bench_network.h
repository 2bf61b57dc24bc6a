/* The learned head's network alone, without features and lifting, on views that have been analysed. */
#ifndef TRIM3R_TOOLS_BENCH_NETWORK_H
#define TRIM3R_TOOLS_BENCH_NETWORK_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

/* Returns the bytes of the features of all views; makes those features, once. The scene in `runtime` must have the head
 * `learned`, bound, and keep_analysis; nothing may have been drawn since. */
size_t bench_network_bytes(const t3r_runtime *runtime);
void bench_network_features(const t3r_runtime *runtime, int8_t *features);

/* Runs the network over all views at their retained points. Returns false unless there are as many as the scene has. */
bool bench_network_run(const t3r_runtime *runtime, const int8_t *features);

#endif
