/* A fixed set of threads behind t3r_hooks.parallel_for. Which thread runs which index never shows in the result:
 * the runtime's tasks write to places of their own. */
#ifndef T3R_PLATFORM_THREADS_H
#define T3R_PLATFORM_THREADS_H

#include <stdint.h>

#include "trim3r.h"

#define T3R_MAX_THREADS T3R_MAX_WORKERS

typedef struct t3r_threads t3r_threads;

/* `count` threads, the caller among them: count - 1 are started. 1..T3R_MAX_THREADS; NULL when the system
 * refuses one or memory runs out. */
t3r_threads *t3r_threads_start(uint32_t count);
/* Joins all; NULL is allowed. */
void t3r_threads_stop(t3r_threads *threads);
uint32_t t3r_threads_count(const t3r_threads *threads);

typedef void t3r_thread_task(void *context, uint32_t index, uint32_t worker);

/* Runs task(context, 0..count-1, worker) and returns when all are done; `worker` is the thread's number, 0 the
 * caller's, so t3r_config.workers is at least the number of threads. Allocates nothing. Not reentrant: a task must not
 * call it. `threads` comes first and untyped so that it serves as the hook itself, with hooks.user = the pool. */
void t3r_threads_run(void *threads, uint32_t count, t3r_thread_task *task, void *context);

#endif
