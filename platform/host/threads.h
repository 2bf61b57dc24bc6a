/* SPDX-License-Identifier: Apache-2.0 */
/* A fixed set of threads for t3r_hooks.parallel_for. Results do not depend on which thread runs which index, because
 * the runtime's tasks write to separate places. */
#ifndef T3R_PLATFORM_THREADS_H
#define T3R_PLATFORM_THREADS_H

#include <stdint.h>

#include "trim3r.h"

#define T3R_MAX_THREADS T3R_MAX_WORKERS

typedef struct t3r_threads t3r_threads;

/* Starts a pool of `count` threads, 1..T3R_MAX_THREADS, of which the caller is one. Returns NULL when the system
 * refuses a thread or memory runs out. */
t3r_threads *t3r_threads_start(uint32_t count);
/* Joins all threads; in a child of fork() only those that it started. NULL is allowed. */
void t3r_threads_stop(t3r_threads *threads);
uint32_t t3r_threads_count(const t3r_threads *threads);

typedef void t3r_thread_task(void *context, uint32_t index, uint32_t worker);

/* Runs task(context, 0..count-1, worker) and returns when all are done; `worker` is the thread's number, 0 for the
 * caller, so t3r_config.workers must be at least the number of threads. Allocates nothing, but the first call in a
 * child of fork() starts threads of its own. Not reentrant: a task must not call it. `threads` comes first and untyped,
 * so that this function can be the hook itself, with hooks.user = the pool. */
void t3r_threads_run(void *threads, uint32_t count, t3r_thread_task *task, void *context);

#endif
