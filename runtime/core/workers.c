/* SPDX-License-Identifier: Apache-2.0 */
#include "workers.h"

#include "fixed.h"

#define BANDS_A_WORKER 2 /* more than one, so that a worker that finishes early gets another */

void t3r_run_tasks(const t3r_workers *workers, uint32_t count, t3r_task *task, void *context)
{
    if (t3r_is_parallel(workers) && count > 1) {
        workers->hooks->parallel_for(workers->hooks->user, count, task, context);
        return;
    }
    for (uint32_t i = 0; i < count; i++) {
        task(context, i, 0);
    }
}

typedef struct rows_job {
    t3r_rows_task *task;
    void *context;
    uint32_t rows, bands;
} rows_job;

static void run_band(void *context, uint32_t index, uint32_t worker)
{
    const rows_job *job = context;
    const t3r_share rows = t3r_share_of(job->rows, index, job->bands);
    job->task(job->context, rows.begin, rows.end, worker);
}

void t3r_run_rows(const t3r_workers *workers, uint32_t rows, t3r_rows_task *task, void *context)
{
    if (!t3r_is_parallel(workers)) {
        task(context, 0, rows, 0);
        return;
    }
    const uint32_t bands = workers->count * BANDS_A_WORKER;
    rows_job job = {task, context, rows, T3R_MAX(T3R_MIN(bands, rows), 1u)};
    t3r_run_tasks(workers, job.bands, run_band, &job);
}
