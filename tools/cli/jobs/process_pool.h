/* SPDX-License-Identifier: Apache-2.0 */
/* Runs independent items of work in several processes. Their parts arrive in the order of the items, for any number of
 * processes.
 *
 * Processes, not threads: a crash loses one item, and no state has to be passed, since a worker is a copy of the
 * caller. So parts may contain pointers to objects that existed before. */
#ifndef TRIM3R_TOOLS_PROCESS_POOL_H
#define TRIM3R_TOOLS_PROCESS_POOL_H

#include <stddef.h>
#include <stdint.h>

#define PROCESS_POOL_MOST 256u /* processes */

typedef struct process_pool_line process_pool_line;

typedef struct process_pool_job {
    uint32_t items;
    uint32_t processes; /* 1: everything runs in the caller's own process */
    /* In a worker, for items in ascending order: sends any number of parts. Returns an exit status of cli.h. */
    int (*make)(void *context, uint32_t item, process_pool_line *line);
    /* In the caller: takes a part as soon as the earlier ones are taken. Returns an exit status of cli.h. */
    int (*take)(void *context, uint32_t item, const void *part, size_t bytes);
    /* In a worker, before it ends; may be NULL. */
    void (*leave)(void *context);
    void *context;
} process_pool_job;

/* Returns CLI_OK, or the status of the first item that failed or the first part that was refused: everything before it
 * has been taken, nothing after it. A worker that dies is reported on stderr. */
int process_pool_run(const process_pool_job *job);

/* Called by make(): sends `bytes` from `part`, followed by those from `more` (NULL: none). */
int process_pool_send(process_pool_line *line, const void *part, size_t bytes, const void *more, size_t more_bytes);

/* Returns the number of processors of this machine, within 1..PROCESS_POOL_MOST. */
uint32_t process_pool_processors(void);

#endif
