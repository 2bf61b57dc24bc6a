/* Counts the pairs of a pixel and a splat that are blended: the cost of drawing and refining a scene. */
#ifndef TRIM3R_TOOLS_BENCH_PAIRS_H
#define TRIM3R_TOOLS_BENCH_PAIRS_H

#include <stdint.h>

#include "trim3r.h"

/* Makes the runtime draw in plain C and count from 0; bench_pairs_end() restores its kernels and returns the pairs. One
 * runtime at a time. */
void bench_pairs_begin(t3r_runtime *runtime);
double bench_pairs_end(t3r_runtime *runtime);

#endif
