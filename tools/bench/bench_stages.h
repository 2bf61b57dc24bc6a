/* What the bench times: a row for each stage, for whole builds, and for what the machine can do at most. */
#ifndef TRIM3R_TOOLS_BENCH_STAGES_H
#define TRIM3R_TOOLS_BENCH_STAGES_H

#include <stdbool.h>

#include "bench/bench_work.h"

typedef struct bench_stage {
    const char *key; /* _ms, _ns_per_..., or a rate: _per_s */
    bool (*run)(bench_work *work);
    bench_scene scene;
    double (*items)(bench_work *work); /* what a run handles; NULL = it is not counted */
    const char *each, *each_key;       /* "ns a point", and its key in JSON; NULL = the row itself is a rate */
} bench_stage;

/* Ends with a key of NULL. */
#define BENCH_STAGES_MOST 16
extern const bench_stage bench_stages[BENCH_STAGES_MOST + 1];

/* A row whose figure is the better the higher it is. */
bool bench_stage_is_rate(const char *key);
/* A row whose run is a whole build, of stages that take their times. */
bool bench_stage_is_build(const char *key);
/* What a run of so many seconds is in the row's unit. */
double bench_stage_figure(const bench_stage *stage, double seconds, double items);

#endif
