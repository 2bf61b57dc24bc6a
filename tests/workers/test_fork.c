/* SPDX-License-Identifier: Apache-2.0 */
/* A child of fork() has none of its parent's threads: a pool of its parent's works there, and ends. */
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <sys/wait.h>
#include <unistd.h>

#include "sanitized.h"
#include "test.h"
#include "trim3r_host.h"

enum { THREADS = 4, COUNT = 1000, SECONDS = 30 };

typedef struct job {
    _Atomic uint32_t seen[COUNT];
    _Atomic uint32_t workers; /* a bit for each that ran a task */
} job;

static bool by_several(uint32_t workers)
{
    return (workers & (workers - 1)) != 0;
}

static void visit(void *context, uint32_t index, uint32_t worker)
{
    job *j = context;
    atomic_fetch_add(&j->seen[index], 1);
    atomic_fetch_or(&j->workers, 1u << worker);
    while (index == 0 && !by_several(atomic_load(&j->workers))) { /* the other threads do the other tasks */
    }
}

/* Whether each index of a job is visited once, by more than one thread. */
static bool works(t3r_threads *pool)
{
    job j = {{0}, 0};
    bool once = true;
    t3r_threads_run(pool, COUNT, visit, &j);
    for (int i = 0; i < COUNT; i++) {
        once = once && j.seen[i] == 1;
    }
    return once && by_several(j.workers);
}

/* Runs a function in a child, which a signal ends if it hangs. Returns whether it was successful. */
static bool in_child(bool (*is_fine)(t3r_threads *), t3r_threads *pool)
{
    const pid_t child = fork();
    if (child == 0) {
        alarm(SECONDS);
        const bool fine = is_fine(pool);
        t3r_threads_stop(pool);
        _exit(fine ? 0 : 1);
    }
    int status = -1;
    return child > 0 && waitpid(child, &status, 0) == child && status == 0;
}

static bool is_idle(t3r_threads *pool)
{
    return t3r_threads_count(pool) == THREADS;
}

static bool works_twice(t3r_threads *pool)
{
    return works(pool) && works(pool);
}

static bool works_in_grandchild(t3r_threads *pool)
{
    return in_child(works, pool) && works(pool) && in_child(works, pool);
}

TEST(children_have_threads_of_their_own)
{
    if (T3R_SANITIZED) {
        puts("SKIPPED: a sanitizer's allocator may stay locked in a child of fork()");
        skip();
    }
    t3r_threads *pool = t3r_threads_start(THREADS);
    assert_non_null(pool);
    assert_true(in_child(works, pool)); /* before the first job */
    assert_true(works(pool));
    assert_true(in_child(is_idle, pool));
    assert_true(in_child(works_twice, pool));
    assert_true(in_child(works_in_grandchild, pool));
    assert_true(works(pool));
    t3r_threads_stop(pool);
}
