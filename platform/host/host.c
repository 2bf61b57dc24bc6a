/* SPDX-License-Identifier: Apache-2.0 */
/* A runtime on this host: its arena, threads and vectors. */
#include <stdlib.h>
#include <string.h>

#include "program_check.h"
#include "reason.h"
#include "trim3r_host.h"

struct t3r_host {
    t3r_runtime *runtime;
    void *arena;
    size_t arena_bytes;
    t3r_threads *threads; /* NULL: the caller's alone */
    t3r_hooks hooks;      /* the caller's */
};

static int pass_progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    const t3r_host *host = user;
    return host->hooks.progress(host->hooks.user, stage, done, total);
}

static void pass_hash(void *user, t3r_stage stage, uint64_t hash)
{
    const t3r_host *host = user;
    host->hooks.stage_hash(host->hooks.user, stage, hash);
}

static void run_parallel(void *user, uint32_t count, t3r_thread_task *task, void *context)
{
    const t3r_host *host = user;
    t3r_threads_run(host->threads, count, task, context);
}

t3r_status t3r_host_set_hooks(t3r_host *host, const t3r_hooks *hooks)
{
    host->hooks = hooks != NULL ? *hooks : (t3r_hooks){0};
    const t3r_hooks own = {
        .user = host,
        .progress = host->hooks.progress != NULL ? pass_progress : NULL,
        .stage_hash = host->hooks.stage_hash != NULL ? pass_hash : NULL,
        .parallel_for = host->threads != NULL ? run_parallel : NULL,
    };
    return t3r_set_hooks(host->runtime, &own);
}

static t3r_status reserve(t3r_host *host, size_t bytes, char *error, size_t error_bytes)
{
    if (posix_memalign(&host->arena, T3R_ARENA_ALIGN, bytes) != 0) {
        host->arena = NULL;
        t3r_reason(error, error_bytes, "no memory for an arena of %zu bytes", bytes);
        return T3R_HOST_ERR_SYSTEM;
    }
    host->arena_bytes = bytes;
    return T3R_OK;
}

/* Gives the runtime the processor's vectors, and a thread for each of its workers. */
static t3r_status equip(t3r_host *host, char *error, size_t error_bytes)
{
    const uint32_t workers = t3r_get_config(host->runtime)->workers;
    if (workers > 1 && (host->threads = t3r_threads_start(workers)) == NULL) {
        t3r_reason(error, error_bytes, "the system refuses %u threads", workers);
        return T3R_HOST_ERR_SYSTEM;
    }
    t3r_status status = t3r_set_cpu(host->runtime, t3r_cpu_features());
    status = status == T3R_OK ? t3r_host_set_hooks(host, NULL) : status;
    t3r_reason(error, error_bytes, "%s", status == T3R_OK ? "" : t3r_error_text(status));
    return status;
}

static t3r_status lay_out(t3r_host *host, const t3r_config *config, char *error, size_t error_bytes)
{
    size_t least, bytes;
    t3r_status status = t3r_plan_bytes(config, &least, &bytes);
    if (status != T3R_OK) {
        (void)t3r_plan_bytes_error(status, config, &least, &bytes, error, error_bytes);
        return status;
    }
    if ((status = reserve(host, bytes, error, error_bytes)) != T3R_OK) {
        return status;
    }
    status = t3r_init(&host->runtime, host->arena, bytes, config);
    if (status != T3R_OK) {
        (void)t3r_init_error(status, &host->runtime, host->arena, bytes, config, error, error_bytes);
        return status;
    }
    return equip(host, error, error_bytes);
}

static t3r_status restore(t3r_host *host, const void *saved, size_t bytes, char *error, size_t error_bytes)
{
    t3r_status status = saved != NULL ? reserve(host, bytes, error, error_bytes) : T3R_ERR_ARGUMENT;
    if (saved == NULL) {
        t3r_reason(error, error_bytes, "saved is NULL");
    }
    if (status != T3R_OK) {
        return status;
    }
    memcpy(host->arena, saved, bytes);
    status = t3r_attach(&host->runtime, host->arena, bytes);
    if (status != T3R_OK) {
        (void)t3r_attach_error(status, &host->runtime, host->arena, bytes, error, error_bytes);
        return status;
    }
    return equip(host, error, error_bytes);
}

t3r_program t3r_host_interface(void)
{
    return t3r_host_program();
}

/* Makes an empty host for a program that fits. */
static t3r_status begin(t3r_program program, t3r_host **host, char *error, size_t error_bytes)
{
    *host = NULL;
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    *host = calloc(1, sizeof **host);
    if (*host == NULL) {
        t3r_reason(error, error_bytes, "out of memory");
        return T3R_HOST_ERR_SYSTEM;
    }
    return T3R_OK;
}

/* Passes the status on; after an error nothing is left of the host. */
static t3r_status end(t3r_host **host, t3r_status status)
{
    if (status != T3R_OK) {
        t3r_host_close(*host);
        *host = NULL;
    }
    return status;
}

t3r_status t3r_host_open_as(t3r_program program, t3r_host **host, const t3r_config *config, uint32_t threads,
                            char *error, size_t error_bytes)
{
    const t3r_status status = begin(program, host, error, error_bytes);
    if (status != T3R_OK) {
        return status;
    }
    t3r_config own = *config;
    own.workers = threads > 0 ? threads : t3r_cpu_count();
    return end(host, lay_out(*host, &own, error, error_bytes));
}

t3r_status t3r_host_attach_as(t3r_program program, t3r_host **host, const void *saved, size_t bytes, char *error,
                              size_t error_bytes)
{
    const t3r_status status = begin(program, host, error, error_bytes);
    return status == T3R_OK ? end(host, restore(*host, saved, bytes, error, error_bytes)) : status;
}

const void *t3r_host_arena(const t3r_host *host, size_t *bytes)
{
    *bytes = host->arena_bytes;
    return host->arena;
}

t3r_runtime *t3r_host_runtime(const t3r_host *host)
{
    return host->runtime;
}

void t3r_host_close(t3r_host *host)
{
    if (host != NULL) {
        t3r_threads_stop(host->threads);
        free(host->arena);
        free(host);
    }
}
