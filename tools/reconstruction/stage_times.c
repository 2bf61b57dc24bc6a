#include "reconstruction/stage_times.h"

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

void stage_times_add_json(cJSON *object, const stage_times *times)
{
    cJSON *stages = cJSON_AddObjectToObject(object, "stages_ms");
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (times->seconds[stage] > 0) {
            cJSON_AddNumberToObject(stages, t3r_stage_name((t3r_stage)stage), times->seconds[stage] * 1e3);
        }
    }
}

void stage_times_print(FILE *out, const stage_times *times)
{
    const double sum = stage_times_sum(times);
    fprintf(out, "%-14s %10s %6s\n", "stage", "ms", "%");
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (times->seconds[stage] > 0) {
            fprintf(out, "%-14s %10.2f %6.1f\n", t3r_stage_name((t3r_stage)stage), times->seconds[stage] * 1e3,
                    times->seconds[stage] / sum * 100);
        }
    }
    fprintf(out, "%-14s %10.2f %6.1f\n", "all", sum * 1e3, 100.0);
}
