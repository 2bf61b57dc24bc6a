/* parallel_for on POSIX threads: they sleep between jobs and draw indices from one shared counter. */
#include "threads.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdlib.h>

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
    uint32_t busy; /* helpers that have not finished the current job */
    uint64_t job;  /* number of the current job */
    bool stop;
    t3r_thread_task *task;
    void *context;
    uint32_t count;
    _Atomic uint64_t next; /* 64 bits: every thread may step past `count` once */
};

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
    uint64_t last_job = 0;
    pthread_mutex_lock(&threads->mutex);
    for (;;) {
        while (!threads->stop && threads->job == last_job) {
            pthread_cond_wait(&threads->job_posted, &threads->mutex);
        }
        if (threads->stop) {
            break;
        }
        last_job = threads->job;
        pthread_mutex_unlock(&threads->mutex);
        draw_indices(threads, self->worker);
        pthread_mutex_lock(&threads->mutex);
        if (--threads->busy == 0) {
            pthread_cond_signal(&threads->job_done);
        }
    }
    pthread_mutex_unlock(&threads->mutex);
    return NULL;
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
    pthread_mutex_init(&threads->mutex, NULL);
    pthread_cond_init(&threads->job_posted, NULL);
    pthread_cond_init(&threads->job_done, NULL);
    for (uint32_t i = 0; i + 1 < count; i++) {
        threads->helpers[i] = (helper){.pool = threads, .worker = i + 1};
        if (pthread_create(&threads->helpers[i].thread, NULL, work, &threads->helpers[i]) != 0) {
            t3r_threads_stop(threads);
            return NULL;
        }
        threads->helper_count++;
    }
    return threads;
}

void t3r_threads_stop(t3r_threads *threads)
{
    if (threads == NULL) {
        return;
    }
    pthread_mutex_lock(&threads->mutex);
    threads->stop = true;
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
    threads->busy = threads->helper_count;
    threads->job++;
    pthread_cond_broadcast(&threads->job_posted);
    pthread_mutex_unlock(&threads->mutex);

    draw_indices(threads, 0);

    /* The mutex orders the helpers' writes before the caller's next read. */
    pthread_mutex_lock(&threads->mutex);
    while (threads->busy != 0) {
        pthread_cond_wait(&threads->job_done, &threads->mutex);
    }
    pthread_mutex_unlock(&threads->mutex);
}
