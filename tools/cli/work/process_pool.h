/* Independent items of work on several processes; what they send arrives in the order of the items, whoever made it.
 *
 * Processes, not threads: a crash costs one item, and nothing needs to be told twice, for a worker is a copy of the
 * caller as it stands. So pointers to what was there before may be sent too. */
#ifndef TRIM3R_TOOLS_PROCESS_POOL_H
#define TRIM3R_TOOLS_PROCESS_POOL_H

#include <stddef.h>
#include <stdint.h>

#define PROCESS_POOL_MOST 256u /* processes */

typedef struct process_pool_line process_pool_line;

typedef struct process_pool_job {
    uint32_t items;
    uint32_t processes; /* 1: all in the caller's own process */
    /* In a worker, of items in rising order: sends any number of parts. An exit status of cli.h. */
    int (*make)(void *context, uint32_t item, process_pool_line *line);
    /* In the caller: a part, as soon as those before it were taken. An exit status of cli.h. */
    int (*take)(void *context, uint32_t item, const void *part, size_t bytes);
    /* In a worker, at its end; may be NULL. */
    void (*leave)(void *context);
    void *context;
} process_pool_job;

/* CLI_OK, or what the first item that failed, or the first part that was not taken, returned: everything before it has
 * been taken, nothing behind it. A worker that dies is reported on stderr. */
int process_pool_run(const process_pool_job *job);

/* Of make(): `bytes` from `part`, and then from `more` (NULL: none). */
int process_pool_send(process_pool_line *line, const void *part, size_t bytes, const void *more, size_t more_bytes);

/* Processors of this machine, within 1..PROCESS_POOL_MOST. */
uint32_t process_pool_processors(void);

#endif
