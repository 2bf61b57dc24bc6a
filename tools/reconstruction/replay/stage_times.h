/* Where the time of a build went, stage by stage. */
#ifndef TRIM3R_TOOLS_STAGE_TIMES_H
#define TRIM3R_TOOLS_STAGE_TIMES_H

#include <cjson/cJSON.h>
#include <stdio.h>
#include <time.h>

#include "host/threads.h"
#include "trim3r.h"

typedef struct stage_times {
    double seconds[T3R_STAGE_COUNT]; /* 0 of a stage that did not run */
    clockid_t clock;
    double since; /* by that clock, when the stage at hand began */
} stage_times;

/* All to 0; the first stage begins now. Of one thread it is processor time, of more elapsed time. */
void stage_times_begin(stage_times *times, uint32_t threads);
/* A stage is done, as the hook stage_hash says: it took the time since the one before. */
void stage_times_end(stage_times *times, t3r_stage stage);
double stage_times_sum(const stage_times *times);
/* Each stage's time becomes that of `other` where that is less, or where it has none. */
void stage_times_keep_least(stage_times *times, const stage_times *other);

/* A runtime whose stages are timed, and nothing else is wanted of it. */
typedef struct stage_clock {
    stage_times times;
    t3r_threads *threads; /* the caller's; NULL: none */
} stage_clock;

/* The hooks that keep the times; the clock must stay where it is. */
t3r_hooks stage_clock_hooks(stage_clock *clock);

/* Under `key`: milliseconds by the stages' names, of those that ran. */
void stage_times_add_json(cJSON *object, const char *key, const stage_times *times);
/* A line a stage that ran: its name, milliseconds, and percent of the sum. */
void stage_times_print(FILE *out, const stage_times *times);

#endif
