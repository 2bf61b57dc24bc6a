/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/stage_times.h"

#include "cli/text/style.h"

static double seconds_of(clockid_t clock)
{
    struct timespec now;
    clock_gettime(clock, &now);
    return (double)now.tv_sec + (double)now.tv_nsec * 1e-9;
}

void stage_times_begin(stage_times *times, uint32_t threads)
{
    const clockid_t clock = threads > 1 ? CLOCK_MONOTONIC : CLOCK_PROCESS_CPUTIME_ID;
    *times = (stage_times){.clock = clock, .since = seconds_of(clock)};
}

void stage_times_end(stage_times *times, t3r_stage stage)
{
    const double now = seconds_of(times->clock);
    times->seconds[stage] += now - times->since;
    times->since = now;
}

double stage_times_sum(const stage_times *times)
{
    double sum = 0;
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        sum += times->seconds[stage];
    }
    return sum;
}

void stage_times_keep_least(stage_times *times, const stage_times *other)
{
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (times->seconds[stage] <= 0 || other->seconds[stage] < times->seconds[stage]) {
            times->seconds[stage] = other->seconds[stage];
        }
    }
}

static void end_stage(void *user, t3r_stage stage, uint64_t hash)
{
    (void)hash;
    stage_clock *clock = user;
    stage_times_end(&clock->times, stage);
}

static void run_parallel(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                         void *context)
{
    stage_clock *clock = user;
    t3r_threads_run(clock->threads, count, task, context);
}

t3r_hooks stage_clock_hooks(stage_clock *clock)
{
    return (t3r_hooks){
        .user = clock,
        .stage_hash = end_stage,
        .parallel_for = clock->threads != NULL ? run_parallel : NULL,
    };
}

void stage_times_add_json(cJSON *object, const char *key, const stage_times *times)
{
    cJSON *stages = cJSON_AddObjectToObject(object, key);
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (times->seconds[stage] > 0) {
            cJSON_AddNumberToObject(stages, t3r_stage_name((t3r_stage)stage), times->seconds[stage] * 1e3);
        }
    }
}

void stage_times_print(FILE *out, const stage_times *times)
{
    const double sum = stage_times_sum(times);
    fprintf(out, "%s%-14s %10s %6s%s\n", style_begin(out, STYLE_HEADING), "stage", "ms", "%", style_end(out));
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (times->seconds[stage] > 0) {
            fprintf(out, "%-14s %10.2f %6.1f\n", t3r_stage_name((t3r_stage)stage), times->seconds[stage] * 1e3,
                    times->seconds[stage] / sum * 100);
        }
    }
    fprintf(out, "%-14s %10.2f %6.1f\n", "all", sum * 1e3, 100.0);
}
