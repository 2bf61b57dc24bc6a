/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/jobs/process_pool.h"

#include <errno.h>
#include <poll.h>
#include <signal.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include "cli/cli.h"

/* Precedes every part; without a part it ends an item. */
typedef struct head {
    uint32_t item;
    int32_t code; /* at an item's end: the result of make() */
    uint64_t bytes;
    bool ends;
} head;

struct process_pool_line {
    const process_pool_job *job; /* in the caller's own process, parts are taken at once */
    int pipe;                    /* in a worker */
    uint32_t item;
};

/* A part that was received before its turn. */
typedef struct part {
    struct part *next;
    head head;
    uint8_t bytes[];
} part;

typedef struct worker {
    pid_t process;
    int pipe; /* -1: the worker has ended */
    head head;
    size_t got; /* bytes received of the head, then of the part */
    part *coming;
} worker;

typedef struct pool {
    const process_pool_job *job;
    worker workers[PROCESS_POOL_MOST];
    uint32_t running;
    part **first, **last; /* per item: first part, and where to append the next one */
    uint32_t turn;        /* the item whose parts are taken now */
} pool;

uint32_t process_pool_processors(void)
{
    long count = sysconf(_SC_NPROCESSORS_ONLN);
    return count < 1 ? 1 : count > (long)PROCESS_POOL_MOST ? PROCESS_POOL_MOST : (uint32_t)count;
}

static bool write_all(int file, const void *bytes, size_t count)
{
    const uint8_t *at = bytes;
    while (count > 0) {
        ssize_t written = write(file, at, count);
        if (written < 0 && errno != EINTR) {
            return false;
        }
        at += written > 0 ? written : 0;
        count -= written > 0 ? (size_t)written : 0;
    }
    return true;
}

static int take_at_once(const process_pool_line *line, const void *bytes, size_t count, const void *more,
                        size_t more_bytes)
{
    uint8_t *whole = malloc(count + more_bytes + 1);
    if (whole == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    memcpy(whole, bytes, count);
    if (more != NULL) {
        memcpy(whole + count, more, more_bytes);
    }
    int code = line->job->take(line->job->context, line->item, whole, count + more_bytes);
    free(whole);
    return code;
}

int process_pool_send(process_pool_line *line, const void *bytes, size_t count, const void *more, size_t more_bytes)
{
    more_bytes = more == NULL ? 0 : more_bytes;
    if (line->job != NULL) {
        return take_at_once(line, bytes, count, more, more_bytes);
    }
    head h = {.item = line->item, .bytes = count + more_bytes};
    bool sent = write_all(line->pipe, &h, sizeof h) && write_all(line->pipe, bytes, count) &&
                (more_bytes == 0 || write_all(line->pipe, more, more_bytes));
    return sent ? CLI_OK : CLI_BAD_INPUT; /* the caller is gone */
}

/* Works on items until none are left, or one fails. */
static void serve(const process_pool_job *job, atomic_uint *next, int pipe)
{
    cli_progress_silence();
    for (;;) {
        uint32_t item = atomic_fetch_add(next, 1);
        if (item >= job->items) {
            break;
        }
        process_pool_line line = {.pipe = pipe, .item = item};
        head end = {.item = item, .code = job->make(job->context, item, &line), .ends = true};
        if (!write_all(pipe, &end, sizeof end) || end.code != CLI_OK) {
            break;
        }
    }
    if (job->leave != NULL) {
        job->leave(job->context);
    }
}

static bool start_worker(pool *p, atomic_uint *next)
{
    int ends[2];
    if (pipe(ends) != 0) {
        return false;
    }
    const pid_t caller = getpid();
    pid_t process = fork();
    if (process == 0) {
        /* ends with the caller; if the caller is gone already, nothing would take the work */
        if (prctl(PR_SET_PDEATHSIG, SIGTERM) != 0 || getppid() != caller) {
            _exit(0);
        }
        close(ends[0]);
        for (uint32_t w = 0; w < p->running; w++) {
            close(p->workers[w].pipe);
        }
        serve(p->job, next, ends[1]);
        _exit(0);
    }
    close(ends[1]);
    if (process < 0) {
        close(ends[0]);
        return false;
    }
    p->workers[p->running++] = (worker){.process = process, .pipe = ends[0]};
    return true;
}

/* Takes the parts of the current item, and of following items once the current one is complete. */
static int take_in_turn(pool *p)
{
    while (p->turn < p->job->items && p->first[p->turn] != NULL) {
        part *it = p->first[p->turn];
        uint32_t item = p->turn;
        p->first[item] = it->next;
        if (it->next == NULL) {
            p->last[item] = NULL;
        }
        int code = it->head.code;
        if (it->head.ends) {
            p->turn++;
        } else {
            code = p->job->take(p->job->context, item, it->bytes, it->head.bytes);
        }
        free(it);
        if (code != CLI_OK) {
            return code;
        }
    }
    return CLI_OK;
}

static void hang(pool *p, part *it)
{
    uint32_t item = it->head.item;
    it->next = NULL;
    if (p->last[item] == NULL) {
        p->first[item] = it;
    } else {
        p->last[item]->next = it;
    }
    p->last[item] = it;
}

/* Handles the end of a worker's pipe. */
static int part_with(worker *w)
{
    int status = 0;
    close(w->pipe);
    w->pipe = -1;
    while (waitpid(w->process, &status, 0) < 0 && errno == EINTR) {
    }
    w->process = 0;
    if (WIFSIGNALED(status)) {
        return cli_error(CLI_BAD_INPUT, "a worker process died of signal %d (%s)", WTERMSIG(status),
                         strsignal(WTERMSIG(status)));
    }
    return WEXITSTATUS(status) == 0 ? CLI_OK : cli_error(CLI_BAD_INPUT, "a worker process failed");
}

/* Reads what has arrived, up to the end of a head or of a part. */
static int hear(pool *p, worker *w)
{
    bool in_head = w->got < sizeof w->head;
    uint8_t *to = in_head ? (uint8_t *)&w->head + w->got : w->coming->bytes + (w->got - sizeof w->head);
    size_t want = in_head ? sizeof w->head - w->got : sizeof w->head + (size_t)w->head.bytes - w->got;
    ssize_t got = read(w->pipe, to, want);
    if (got < 0 && errno == EINTR) {
        return CLI_OK;
    }
    if (got <= 0) {
        return part_with(w);
    }
    w->got += (size_t)got;
    if (in_head && w->got == sizeof w->head) {
        w->coming = malloc(sizeof *w->coming + (size_t)w->head.bytes);
        if (w->coming == NULL) {
            return cli_error(CLI_BAD_INPUT, "out of memory");
        }
        w->coming->head = w->head;
    }
    if (w->got < sizeof w->head || w->got < sizeof w->head + w->head.bytes) {
        return CLI_OK;
    }
    hang(p, w->coming);
    w->coming = NULL;
    w->got = 0;
    return take_in_turn(p);
}

static int listen_to_all(pool *p)
{
    int code = CLI_OK;
    for (uint32_t open = p->running; open > 0 && code == CLI_OK;) {
        struct pollfd files[PROCESS_POOL_MOST];
        for (uint32_t w = 0; w < p->running; w++) {
            files[w] =
                (struct pollfd){.fd = p->workers[w].pipe, .events = POLLIN}; /* negative descriptors are ignored */
        }
        if (poll(files, p->running, -1) < 0 && errno != EINTR) {
            return cli_error(CLI_BAD_INPUT, "poll: %s", strerror(errno));
        }
        for (uint32_t w = 0; w < p->running && code == CLI_OK; w++) {
            if (p->workers[w].pipe >= 0 && files[w].revents != 0) {
                code = hear(p, &p->workers[w]);
                open -= p->workers[w].pipe < 0;
            }
        }
    }
    return code;
}

static void dismiss(pool *p)
{
    for (uint32_t i = 0; i < p->running; i++) {
        worker *w = &p->workers[i];
        if (w->process > 0) {
            kill(w->process, SIGTERM); /* its handler removes incomplete files */
            close(w->pipe);
            (void)waitpid(w->process, NULL, 0);
        }
        free(w->coming);
    }
    for (uint32_t i = 0; i < p->job->items && p->first != NULL; i++) {
        while (p->first[i] != NULL) {
            part *it = p->first[i];
            p->first[i] = it->next;
            free(it);
        }
    }
    free(p->first);
    free(p->last);
}

static int run_here(const process_pool_job *job)
{
    int code = CLI_OK;
    for (uint32_t item = 0; item < job->items && code == CLI_OK; item++) {
        process_pool_line line = {.job = job, .pipe = -1, .item = item};
        code = job->make(job->context, item, &line);
    }
    if (job->leave != NULL) {
        job->leave(job->context);
    }
    return code;
}

int process_pool_run(const process_pool_job *job)
{
    uint32_t processes = job->processes < job->items ? job->processes : job->items;
    processes = processes < PROCESS_POOL_MOST ? processes : PROCESS_POOL_MOST;
    if (processes <= 1) {
        return run_here(job);
    }
    pool p = {.job = job};
    p.first = calloc(job->items, sizeof(part *));
    p.last = calloc(job->items, sizeof(part *));
    atomic_uint *next = mmap(NULL, sizeof *next, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
    int code = CLI_OK;
    if (p.first == NULL || p.last == NULL || next == MAP_FAILED) {
        code = cli_error(CLI_BAD_INPUT, "out of memory");
    } else {
        atomic_init(next, 0);
        fflush(NULL); /* or every worker would inherit the unwritten output */
        for (uint32_t w = 0; w < processes && code == CLI_OK; w++) {
            code = start_worker(&p, next) ? CLI_OK : cli_error(CLI_BAD_INPUT, "no process: %s", strerror(errno));
        }
        code = code == CLI_OK ? listen_to_all(&p) : code;
    }
    dismiss(&p);
    if (next != MAP_FAILED) {
        munmap(next, sizeof *next);
    }
    return code;
}
