/* SPDX-License-Identifier: Apache-2.0 */
/* Work that may run on several threads at once: numbered tasks, passed to the caller's hook.
 *
 * A task writes only to memory that no other task of the same call reads or writes, or to its worker's own memory.
 * So neither the order of tasks nor the number of workers changes the result. */
#ifndef T3R_WORKERS_H
#define T3R_WORKERS_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

typedef void t3r_task(void *context, uint32_t index, uint32_t worker);

typedef struct t3r_workers {
    const t3r_hooks *hooks; /* NULL or without parallel_for: worker 0 runs the tasks one after the other */
    uint32_t count;         /* 1..T3R_MAX_WORKERS */
} t3r_workers;

/* Whether tasks may run in parallel; a constant false in builds for one worker. */
static inline bool t3r_is_parallel(const t3r_workers *workers)
{
    return T3R_FEATURE_EXTRAS && workers->count > 1 && workers->hooks != NULL && workers->hooks->parallel_for != NULL;
}

/* Runs task(context, 0..count-1, worker) and returns when all are done. */
void t3r_run_tasks(const t3r_workers *workers, uint32_t count, t3r_task *task, void *context);

/* A task's part of `total` items, begin..end - 1: tasks 0..tasks - 1 get consecutive parts without gaps, which differ
 * by at most one item. total < 2^26, tasks <= 2 T3R_MAX_WORKERS. */
typedef struct t3r_share {
    uint32_t begin, end;
} t3r_share;

static inline t3r_share t3r_share_of(uint32_t total, uint32_t index, uint32_t tasks)
{
    return (t3r_share){(uint32_t)((uint64_t)total * index / tasks), (uint32_t)((uint64_t)total * (index + 1) / tasks)};
}

/* Runs tasks over the rows 0..rows - 1: task(context, begin, end, worker) takes begin..end - 1. */
typedef void t3r_rows_task(void *context, uint32_t begin, uint32_t end, uint32_t worker);
void t3r_run_rows(const t3r_workers *workers, uint32_t rows, t3r_rows_task *task, void *context);

#endif
