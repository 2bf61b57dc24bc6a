/* SPDX-License-Identifier: Apache-2.0 */
/* parallel_for on POSIX threads, which draw indices from one shared counter.
 *
 * A build has hundreds of jobs of a few hundred microseconds. Waking a thread takes about a tenth of that, far more in
 * a virtual machine. So a waiting thread spins for a while before it sleeps, and a job waits only for the helpers that
 * have joined it: on a busy machine the others come too late to help. */
#include "trim3r_host.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>
#include <sys/types.h>
#include <time.h>
#include <unistd.h>

#define LOOK_NS 200000  /* how long a thread spins before it sleeps */
#define LOOKS 64        /* tests between two looks at the clock */
#define OPEN (1u << 31) /* in t3r_threads.busy: helpers may join the job */

/* A started thread; worker 0 is the caller. */
typedef struct helper {
    t3r_threads *pool;
    uint32_t worker;
    pthread_t thread;
} helper;

struct t3r_threads {
    pthread_mutex_t mutex;
    pthread_cond_t job_posted, job_done;
    helper helpers[T3R_MAX_THREADS - 1];
    uint32_t helper_count;
    pid_t process;         /* the helpers' */
    bool looks;            /* spins: there are processors for all threads */
    _Atomic uint32_t busy; /* helpers that have joined the current job and not finished, and OPEN */
    _Atomic uint64_t job;  /* number of the current job; it changes under the mutex */
    _Atomic bool stop;     /* likewise */
    t3r_thread_task *task;
    void *context;
    uint32_t count;
    _Atomic uint64_t next; /* 64 bits: every thread may step past `count` once */
};

static void relax(void)
{
#if defined(__x86_64__) || defined(__i386__)
    __builtin_ia32_pause();
#elif defined(__aarch64__)
    __asm__ __volatile__("yield");
#endif
}

static int64_t now_ns(void)
{
    struct timespec t;
    clock_gettime(CLOCK_MONOTONIC, &t);
    return (int64_t)t.tv_sec * 1000000000 + t.tv_nsec;
}

static bool has_job(const t3r_threads *threads, uint64_t last_job)
{
    return atomic_load_explicit(&threads->job, memory_order_acquire) != last_job ||
           atomic_load_explicit(&threads->stop, memory_order_acquire);
}

static bool is_done(const t3r_threads *threads, uint64_t unused)
{
    (void)unused;
    return atomic_load_explicit(&threads->busy, memory_order_acquire) == 0;
}

/* Spins for a while until is_so() holds; false: not known. */
static bool look(const t3r_threads *threads, bool (*is_so)(const t3r_threads *, uint64_t), uint64_t argument)
{
    for (int64_t begun = now_ns(); threads->looks && now_ns() - begun < LOOK_NS;) {
        for (int i = 0; i < LOOKS; i++) {
            if (is_so(threads, argument)) {
                return true;
            }
            relax();
        }
    }
    return false;
}

/* Joins the current job, whichever it is, unless all its indices are drawn. Acquires the job's fields. */
static bool join_job(t3r_threads *threads)
{
    uint32_t busy = atomic_load_explicit(&threads->busy, memory_order_relaxed);
    while ((busy & OPEN) != 0) {
        if (atomic_compare_exchange_weak_explicit(&threads->busy, &busy, busy + 1, memory_order_acquire,
                                                  memory_order_relaxed)) {
            return true;
        }
    }
    return false;
}

static void draw_indices(t3r_threads *threads, uint32_t worker)
{
    for (;;) {
        uint64_t index = atomic_fetch_add_explicit(&threads->next, 1, memory_order_relaxed);
        if (index >= threads->count) {
            return;
        }
        threads->task(threads->context, (uint32_t)index, worker);
    }
}

static void *work(void *argument)
{
    const helper *self = argument;
    t3r_threads *threads = self->pool;
    for (uint64_t last_job = 0;;) {
        if (!look(threads, has_job, last_job)) {
            pthread_mutex_lock(&threads->mutex);
            while (!has_job(threads, last_job)) {
                pthread_cond_wait(&threads->job_posted, &threads->mutex);
            }
            pthread_mutex_unlock(&threads->mutex);
        }
        if (atomic_load_explicit(&threads->stop, memory_order_acquire)) {
            return NULL;
        }
        last_job = atomic_load_explicit(&threads->job, memory_order_acquire);
        if (!join_job(threads)) {
            continue;
        }
        draw_indices(threads, self->worker);
        /* Releases this thread's writes to the thread that sees busy = 0. */
        if (atomic_fetch_sub_explicit(&threads->busy, 1, memory_order_acq_rel) == 1) {
            pthread_mutex_lock(&threads->mutex);
            pthread_cond_signal(&threads->job_done);
            pthread_mutex_unlock(&threads->mutex);
        }
    }
}

/* Starts up to `count` helpers. Returns whether all of them run. */
static bool start_helpers(t3r_threads *threads, uint32_t count)
{
    pthread_mutex_init(&threads->mutex, NULL);
    pthread_cond_init(&threads->job_posted, NULL);
    pthread_cond_init(&threads->job_done, NULL);
    threads->process = getpid();
    for (threads->helper_count = 0; threads->helper_count < count; threads->helper_count++) {
        helper *next = &threads->helpers[threads->helper_count];
        *next = (helper){.pool = threads, .worker = threads->helper_count + 1};
        if (pthread_create(&next->thread, NULL, work, next) != 0) {
            return false;
        }
    }
    return true;
}

/* Starts the helpers again in a child of fork(), which has none of its parent's threads; fewer if the system refuses.
 */
static void follow_fork(t3r_threads *threads)
{
    if (threads->process != getpid()) {
        atomic_store_explicit(&threads->job, 0, memory_order_relaxed);
        (void)start_helpers(threads, threads->helper_count);
    }
}

t3r_threads *t3r_threads_start(uint32_t count)
{
    if (count == 0 || count > T3R_MAX_THREADS) {
        return NULL;
    }
    t3r_threads *threads = calloc(1, sizeof *threads);
    if (threads == NULL) {
        return NULL;
    }
    threads->looks = sysconf(_SC_NPROCESSORS_ONLN) >= (long)count;
    if (!start_helpers(threads, count - 1)) {
        t3r_threads_stop(threads);
        return NULL;
    }
    return threads;
}

void t3r_threads_stop(t3r_threads *threads)
{
    if (threads == NULL || threads->process != getpid()) {
        free(threads); /* the threads are the parent's */
        return;
    }
    pthread_mutex_lock(&threads->mutex);
    atomic_store_explicit(&threads->stop, true, memory_order_release);
    pthread_cond_broadcast(&threads->job_posted);
    pthread_mutex_unlock(&threads->mutex);
    for (uint32_t i = 0; i < threads->helper_count; i++) {
        pthread_join(threads->helpers[i].thread, NULL);
    }
    pthread_cond_destroy(&threads->job_done);
    pthread_cond_destroy(&threads->job_posted);
    pthread_mutex_destroy(&threads->mutex);
    free(threads);
}

uint32_t t3r_threads_count(const t3r_threads *threads)
{
    return threads->helper_count + 1;
}

void t3r_threads_run(void *pool, uint32_t count, t3r_thread_task *task, void *context)
{
    t3r_threads *threads = pool;
    follow_fork(threads);
    if (threads->helper_count == 0 || count < 2) {
        for (uint32_t i = 0; i < count; i++) {
            task(context, i, 0);
        }
        return;
    }
    pthread_mutex_lock(&threads->mutex);
    threads->task = task;
    threads->context = context;
    threads->count = count;
    atomic_store_explicit(&threads->next, 0, memory_order_relaxed);
    atomic_store_explicit(&threads->busy, OPEN, memory_order_release);
    atomic_fetch_add_explicit(&threads->job, 1, memory_order_release);
    pthread_cond_broadcast(&threads->job_posted);
    pthread_mutex_unlock(&threads->mutex);

    draw_indices(threads, 0);
    atomic_fetch_and_explicit(&threads->busy, ~OPEN, memory_order_relaxed);

    if (!look(threads, is_done, 0)) {
        pthread_mutex_lock(&threads->mutex);
        while (!is_done(threads, 0)) {
            pthread_cond_wait(&threads->job_done, &threads->mutex);
        }
        pthread_mutex_unlock(&threads->mutex);
    }
}
