/* How many pairs of a pixel and a splat are blended: what drawing and refining a scene come to. */
#ifndef TRIM3R_TOOLS_BENCH_PAIRS_H
#define TRIM3R_TOOLS_BENCH_PAIRS_H

#include <stdint.h>

#include "trim3r.h"

/* Lets the runtime's drawing count in plain C from now on, from 0; bench_pairs_end() gives it its kernels back and
 * returns the pairs. One runtime at a time. */
void bench_pairs_begin(t3r_runtime *runtime);
double bench_pairs_end(t3r_runtime *runtime);

#endif
