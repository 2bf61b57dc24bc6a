/* SPDX-License-Identifier: Apache-2.0 */
/* The pool: every index exactly once, whatever the number of threads, job after job, and also while a thread does not
 * run. */
#include <pthread.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <string.h>
#include <time.h>

#include "test.h"
#include "trim3r_host.h"

#define MOST 3000u

typedef struct job {
    uint32_t threads;
    atomic_bool busy[T3R_MAX_THREADS];
    uint8_t visits[MOST];
} job;

static void visit(void *context, uint32_t index, uint32_t worker)
{
    job *j = context;
    assert_true(worker < j->threads);
    assert_false(atomic_exchange(&j->busy[worker], true)); /* a worker does one task at a time */
    j->visits[index]++;                                    /* each index belongs to one thread */
    atomic_store(&j->busy[worker], false);
}

TEST(visits_every_index_once)
{
    static const uint32_t threads[] = {1, 2, 5, 16}, counts[] = {0, 1, 2, 7, MOST};
    for (size_t t = 0; t < sizeof threads / sizeof threads[0]; t++) {
        t3r_threads *pool = t3r_threads_start(threads[t]);
        assert_non_null(pool);
        assert_int_equal(t3r_threads_count(pool), threads[t]);
        for (int repeat = 0; repeat < 40; repeat++) {
            for (size_t c = 0; c < sizeof counts / sizeof counts[0]; c++) {
                job j;
                memset(&j, 0, sizeof j);
                j.threads = threads[t];
                t3r_threads_run(pool, counts[c], visit, &j);
                for (uint32_t i = 0; i < MOST; i++) {
                    assert_int_equal(j.visits[i], i < counts[c] ? 1 : 0);
                }
            }
        }
        t3r_threads_stop(pool);
    }
}

static pthread_t helper;
static atomic_bool met, held, freed;

static void rest(void)
{
    nanosleep(&(struct timespec){.tv_nsec = 1000000}, NULL);
}

/* Worker 1 names its thread; worker 0 waits for that. */
static void meet(void *context, uint32_t index, uint32_t worker)
{
    (void)context;
    (void)index;
    if (worker == 1) {
        helper = pthread_self();
        atomic_store(&met, true);
    }
    while (!atomic_load(&met)) {
        rest();
    }
}

static void hold(int signal)
{
    (void)signal;
    atomic_store(&held, true);
    while (!atomic_load(&freed)) {
        rest();
    }
}

static void count(void *context, uint32_t index, uint32_t worker)
{
    (void)index;
    assert_int_equal(worker, 0);
    ++*(uint32_t *)context;
}

/* A job that is done does not wait for a thread that has no processor. */
TEST(waits_only_for_threads_that_have_joined)
{
    t3r_threads *pool = t3r_threads_start(2);
    assert_non_null(pool);
    t3r_threads_run(pool, 2, meet, NULL);
    for (int i = 0; i < 200; i++) {
        rest(); /* until the helper sleeps and holds no mutex */
    }
    assert_int_equal(sigaction(SIGUSR1, &(struct sigaction){.sa_handler = hold}, NULL), 0);
    assert_int_equal(pthread_kill(helper, SIGUSR1), 0);
    while (!atomic_load(&held)) {
        rest();
    }
    uint32_t counted = 0;
    for (uint32_t i = 1; i <= 50; i++) {
        t3r_threads_run(pool, 4, count, &counted);
        assert_int_equal(counted, 4 * i);
    }
    atomic_store(&freed, true);
    t3r_threads_stop(pool);
}

TEST(refuses_impossible_counts)
{
    assert_null(t3r_threads_start(0));
    assert_null(t3r_threads_start(T3R_MAX_THREADS + 1));
    t3r_threads_stop(NULL);
}
