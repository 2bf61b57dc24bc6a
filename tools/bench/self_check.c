/* SPDX-License-Identifier: Apache-2.0 */
#include "bench/self_check.h"

#include <stdlib.h>

#include "cli/cli.h"
#include "core/hash.h"
#include "reconstruction/chosen_head.h"
#include "room/room.h"
#include "trim3r_host.h"

enum { SIDE = 64, VIEWS = 2, BUDGET = 400, SEED = 1, PIXELS = SIDE * SIDE };

/* A change of any bit needs a new epoch, and a new hash: `trim3r doctor` prints it. */
_Static_assert(T3R_BITS_EPOCH == 19, "SELF_CHECK_HASH is that of another bits epoch");

typedef struct check {
    uint8_t rgb[PIXELS * 3], depth[PIXELS * 2], view[PIXELS * 3];
    uint16_t depth_mm[PIXELS];
    uint64_t hash;
    t3r_threads *threads;
    chosen_head head;
    void *arena;
    t3r_runtime *runtime;
} check;

static void keep_hash(void *user, t3r_stage stage, uint64_t hash)
{
    check *c = user;
    c->hash = t3r_hash_u64(t3r_hash_u8(c->hash, (uint8_t)stage), hash);
}

static void run_parallel(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                         void *context)
{
    check *c = user;
    t3r_threads_run(c->threads, count, task, context);
}

static t3r_status open(check *c, const processor_options *processor)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, BUDGET);
    t3r_plan_info plan;
    chosen_head_configure(&c->head, &config);
    config.workers = processor->threads;
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK || posix_memalign(&c->arena, T3R_ARENA_ALIGN, plan.bytes) != 0) {
        c->arena = NULL;
        return status != T3R_OK ? status : T3R_ERR_ARENA;
    }
    const t3r_hooks hooks = {
        .user = c, .stage_hash = keep_hash, .parallel_for = c->threads != NULL ? run_parallel : NULL};
    status = t3r_init(&c->runtime, c->arena, plan.bytes, &config);
    if (status == T3R_OK) {
        (void)t3r_set_cpu(c->runtime, processor->cpu);
        status = t3r_set_hooks(c->runtime, &hooks);
    }
    return status == T3R_OK ? t3r_bind_head(c->runtime, c->head.weights, c->head.bytes) : status;
}

/* Adds frame `index` of the room, with depth as little-endian bytes. */
static t3r_status add_frame(check *c, uint32_t index)
{
    t3r_camera camera;
    room_camera(index, SIDE, SIDE, &camera);
    room_frame(index, SIDE, SIDE, SEED, c->rgb, c->depth_mm);
    for (uint32_t i = 0; i < PIXELS; i++) {
        c->depth[2 * i] = (uint8_t)(c->depth_mm[i] & 255);
        c->depth[2 * i + 1] = (uint8_t)(c->depth_mm[i] >> 8);
    }
    const t3r_frame frame = {
        .format = T3R_PIXEL_RGB24,
        .width = SIDE,
        .height = SIDE,
        .planes = {c->rgb},
        .stride_bytes = {3 * SIDE},
        .depth = c->depth,
        .depth_width = SIDE,
        .depth_height = SIDE,
        .depth_stride_bytes = 2 * SIDE,
        .depth_unit_q40 = ROOM_DEPTH_UNIT_Q40,
    };
    return t3r_add_view(c->runtime, &frame, &camera);
}

static t3r_status run(check *c, const processor_options *processor)
{
    t3r_scene scene;
    t3r_camera camera;
    t3r_status status = open(c, processor);
    for (uint32_t v = 0; v < VIEWS && status == T3R_OK; v++) {
        status = add_frame(c, 2 * v);
    }
    status = status == T3R_OK ? t3r_reconstruct(c->runtime, NULL, &scene) : status;
    if (status == T3R_OK) {
        const t3r_target target = {.width = SIDE, .height = SIDE, .rgb = c->view, .rgb_stride_bytes = 3 * SIDE};
        room_camera(1, SIDE, SIDE, &camera);
        status = t3r_render(c->runtime, &camera, &target);
    }
    c->hash = t3r_hash_bytes(c->hash, c->view, sizeof c->view);
    return status;
}

int self_check_run(const processor_options *processor, uint64_t *hash)
{
    check *c = calloc(1, sizeof *c);
    if (c == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    c->hash = T3R_HASH_START;
    int code = CLI_OK;
    if (processor->threads > 1 && (c->threads = t3r_threads_start(processor->threads)) == NULL) {
        code = cli_error(CLI_BAD_INPUT, "the system refuses %u threads", (unsigned)processor->threads);
    }
    code = code == CLI_OK ? chosen_head_open(&c->head, "small") : code;
    if (code == CLI_OK) {
        const t3r_status status = run(c, processor);
        code = status == T3R_OK ? CLI_OK : cli_error(CLI_BAD_INPUT, "the self-check: %s", t3r_error_text(status));
    }
    *hash = c->hash;
    chosen_head_close(&c->head);
    t3r_threads_stop(c->threads);
    free(c->arena);
    free(c);
    return code;
}
