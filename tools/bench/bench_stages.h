/* SPDX-License-Identifier: Apache-2.0 */
/* The rows of the bench: each stage, whole builds, and the machine's upper limits. */
#ifndef TRIM3R_TOOLS_BENCH_STAGES_H
#define TRIM3R_TOOLS_BENCH_STAGES_H

#include <stdbool.h>

#include "bench/bench_work.h"

typedef struct bench_stage {
    const char *key; /* _ms, _ns_per_..., or a rate: _per_s */
    bool (*run)(bench_work *work);
    bench_scene scene;
    double (*items)(bench_work *work); /* items that a run handles; NULL = not counted */
    const char *each, *each_key;       /* "ns a point", and its key in JSON; NULL = the row itself is a rate */
} bench_stage;

/* Terminated by a key of NULL. */
#define BENCH_STAGES_MOST 16
extern const bench_stage bench_stages[BENCH_STAGES_MOST + 1];

/* Whether a higher figure of a row is better. */
bool bench_stage_is_rate(const char *key);
/* Whether a row's run is a whole build, made of stages with times of their own. */
bool bench_stage_is_build(const char *key);
/* Converts the seconds of a run to the row's unit. */
double bench_stage_figure(const bench_stage *stage, double seconds, double items);

#endif
