/* SPDX-License-Identifier: Apache-2.0 */
/* The times of a build by stage. */
#ifndef TRIM3R_TOOLS_STAGE_TIMES_H
#define TRIM3R_TOOLS_STAGE_TIMES_H

#include <cjson/cJSON.h>
#include <stdio.h>
#include <time.h>

#include "trim3r.h"
#include "trim3r_host.h"

typedef struct stage_times {
    double seconds[T3R_STAGE_COUNT]; /* 0 for a stage that did not run */
    clockid_t clock;
    double since; /* start of the current stage, by that clock */
} stage_times;

/* Sets all to 0; the first stage begins now. With one thread it is processor time, else elapsed time. */
void stage_times_begin(stage_times *times, uint32_t threads);
/* Ends a stage, as the hook stage_hash reports: it took the time since the previous one. */
void stage_times_end(stage_times *times, t3r_stage stage);
double stage_times_sum(const stage_times *times);
/* Replaces each stage's time by `other`'s if that is less, or if it has none. */
void stage_times_keep_least(stage_times *times, const stage_times *other);

/* A runtime whose stages are only timed. */
typedef struct stage_clock {
    stage_times times;
    t3r_threads *threads; /* the caller's; NULL = none */
} stage_clock;

/* Returns the hooks that measure the times; the clock must not move. */
t3r_hooks stage_clock_hooks(stage_clock *clock);

/* Adds under `key` the milliseconds of the stages that ran, by name. */
void stage_times_add_json(cJSON *object, const char *key, const stage_times *times);
/* Prints a line per stage that ran: its name, milliseconds, and percent of the sum. */
void stage_times_print(FILE *out, const stage_times *times);

#endif
