/* SPDX-License-Identifier: Apache-2.0 */
/* The arena of a run, its hooks and the hashes that they collect. */
#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/fixed.h"
#include "core/hash.h"
#include "head/head.h"
#include "reconstruction/reconstruction.h"
#include "reconstruction/reconstruction_error.h"
#include "state/state.h"

static int show_progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    const reconstruction *r = user;
    cli_progress(t3r_stage_name(stage), done, total);
    return r->give_up_at > 0 && cli_now() > r->give_up_at;
}

static void keep_hash(void *user, t3r_stage stage, uint64_t hash)
{
    reconstruction *r = user;
    if (r->uncounted) {
        return;
    }
    r->stage_hash[stage] = r->stage_hashed[stage] ? t3r_hash_u64(r->stage_hash[stage], hash) : hash;
    r->stage_hashed[stage] = true;
    stage_times_end(&r->stages, stage);
}

static void run_parallel(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                         void *context)
{
    reconstruction *r = user;
    t3r_threads_run(r->threads, count, task, context);
}

uint64_t reconstruction_hash(const reconstruction *r)
{
    uint64_t hash = T3R_HASH_START;
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        if (r->stage_hashed[stage]) {
            hash = t3r_hash_u64(t3r_hash_u8(hash, (uint8_t)stage), r->stage_hash[stage]);
        }
    }
    return hash;
}

void reconstruction_clear_hashes(reconstruction *r)
{
    memset(r->stage_hash, 0, sizeof r->stage_hash);
    memset(r->stage_hashed, 0, sizeof r->stage_hashed);
}

t3r_hooks reconstruction_hooks(reconstruction *r, const reconstruction_options *options)
{
    return (t3r_hooks){
        .user = r,
        .stage_hash = options->hash ? keep_hash : NULL,
        .parallel_for = r->threads != NULL ? run_parallel : NULL,
    };
}

/* Returns the bytes with which no stage takes longer than with more: a view is drawn in one pass, and each worker packs
 * the layers of the head. */
static size_t full_bytes(const reconstruction *r, const t3r_plan_info *plan)
{
    const size_t packed =
        r->head.weights != NULL ? t3r_head_learned_packed_bytes(r->head.weights, r->config.width) : SIZE_MAX;
    if (packed == SIZE_MAX) { /* no network, or one that is not packed */
        return plan->bytes;
    }
    const size_t below = plan->buffers[T3R_BUFFER_HEAD_WORK].offset + r->config.workers * T3R_UP_(packed);
    return T3R_MAX(plan->bytes, below + plan->buffers[T3R_BUFFER_SCENE].bytes);
}

int reconstruction_allocate(reconstruction *r, const reconstruction_options *options)
{
    t3r_plan_info plan;
    r->config.workers = options->processor.threads;
    t3r_status status = t3r_plan(&r->config, &plan);
    if (status != T3R_OK) {
        return reconstruction_error(status, "settings", &r->config, 0);
    }
    uint64_t bytes = options->arena == ARENA_BYTES ? options->arena_bytes
                     : options->arena == ARENA_MIN ? plan.min_bytes
                                                   : full_bytes(r, &plan);
    if (bytes < plan.min_bytes) {
        return reconstruction_error(T3R_ERR_ARENA, "arena", &r->config, (size_t)bytes);
    }
    if (bytes > SIZE_MAX || posix_memalign(&r->arena, T3R_ARENA_ALIGN, (size_t)bytes) != 0) {
        r->arena = NULL;
        return cli_error(CLI_BAD_INPUT, "no memory for an arena of %" PRIu64 " bytes", bytes);
    }
    r->arena_bytes = (size_t)bytes;
    if (options->processor.threads > 1) {
        r->threads = t3r_threads_start(options->processor.threads);
        if (r->threads == NULL) {
            return cli_error(CLI_BAD_INPUT, "the system refuses %" PRIu32 " threads", options->processor.threads);
        }
    }
    return CLI_OK;
}

int reconstruction_open_arena(reconstruction *r, const reconstruction_options *options)
{
    int code = reconstruction_allocate(r, options);
    if (code != CLI_OK) {
        return code;
    }
    t3r_status status = t3r_init(&r->runtime, r->arena, r->arena_bytes, &r->config);
    if (status != T3R_OK) {
        return reconstruction_error(status, "arena", &r->config, r->arena_bytes);
    }
    t3r_hooks hooks = reconstruction_hooks(r, options);
    hooks.progress = show_progress;
    (void)t3r_set_cpu(r->runtime, options->processor.cpu);
    status = t3r_set_hooks(r->runtime, &hooks);
    return status == T3R_OK ? CLI_OK : reconstruction_error(status, "hooks", &r->config, r->arena_bytes);
}

void reconstruction_close(reconstruction *r)
{
    cli_progress_end();
    t3r_threads_stop(r->threads);
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        free(r->shown[v]);
    }
    free(r->arena);
    chosen_head_close(&r->head);
    scene_file_free(&r->loaded);
    *r = (reconstruction){0};
}
