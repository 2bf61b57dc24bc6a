/* Two small builds of the built-in room and a view of each, in plain C on one thread. Under callgrind each stage's
 * instructions are a part of the output of their own, named by the build and the stage. */
#include <stdio.h>
#include <stdlib.h>

#include <valgrind/callgrind.h>

#include "room/room.h"
#include "rgbd_frame.h"
#include "trim3r.h"
#include "trim3r_heads.h"

enum { SIDE = 96, VIEWS = 2, BUDGET = 1843, CLUSTERS = 64, SEED = 1, PIXELS = SIDE * SIDE };

static const struct {
    const char *name;
    t3r_head head;
    t3r_depth depth;
} builds[] = {{"small", T3R_HEAD_LEARNED, T3R_DEPTH_SENSOR}, {"stereo", T3R_HEAD_ANALYTIC, T3R_DEPTH_STEREO}};

static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2], view[PIXELS * 3];
static uint16_t depth_mm[PIXELS];
static const char *build;

/* What was counted since the last part is that stage's. */
static void end_stage(void *user, t3r_stage stage, uint64_t hash)
{
    char name[64];
    (void)user;
    (void)hash;
    snprintf(name, sizeof name, "%s %s", build, t3r_stage_name(stage));
    CALLGRIND_DUMP_STATS_AT(name);
    CALLGRIND_ZERO_STATS;
}

static t3r_status add_frame(t3r_runtime *runtime, uint32_t index)
{
    t3r_camera camera;
    room_camera(index, SIDE, SIDE, &camera);
    room_frame(index, SIDE, SIDE, SEED, rgb, depth_mm);
    for (uint32_t i = 0; i < PIXELS; i++) {
        depth[2 * i] = (uint8_t)(depth_mm[i] & 255);
        depth[2 * i + 1] = (uint8_t)(depth_mm[i] >> 8);
    }
    const t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
    CALLGRIND_ZERO_STATS;
    return t3r_add_view(runtime, &frame, &camera);
}

static t3r_status run(t3r_runtime *runtime)
{
    t3r_scene scene;
    t3r_camera camera;
    const t3r_target target = {.width = SIDE, .height = SIDE, .rgb = view, .rgb_stride_bytes = 3 * SIDE};
    t3r_status status = T3R_OK;
    for (uint32_t v = 0; v < VIEWS && status == T3R_OK; v++) {
        status = add_frame(runtime, 2 * v);
    }
    CALLGRIND_ZERO_STATS;
    status = status == T3R_OK ? t3r_reconstruct(runtime, NULL, &scene) : status;
    room_camera(1, SIDE, SIDE, &camera);
    CALLGRIND_ZERO_STATS;
    status = status == T3R_OK ? t3r_render(runtime, &camera, &target) : status;
    end_stage(NULL, T3R_STAGE_RASTER, 0); /* without a hook of its own, or what is left behind it */
    return status;
}

int main(void)
{
    for (size_t i = 0; i < sizeof builds / sizeof builds[0]; i++) {
        t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, BUDGET);
        t3r_plan_info plan;
        t3r_runtime *runtime;
        void *arena;
        build = builds[i].name;
        config.head = builds[i].head;
        config.depth = builds[i].depth;
        config.clusters = CLUSTERS;
        if (t3r_plan(&config, &plan) != T3R_OK || posix_memalign(&arena, T3R_ARENA_ALIGN, plan.bytes) != 0) {
            return 1;
        }
        const t3r_hooks hooks = {.stage_hash = end_stage};
        t3r_status status = t3r_init(&runtime, arena, plan.bytes, &config);
        status = status == T3R_OK ? t3r_set_hooks(runtime, &hooks) : status;
        if (status == T3R_OK && config.head == T3R_HEAD_LEARNED) {
            status = t3r_bind_head(runtime, t3r_head_small, t3r_head_small_bytes);
        }
        status = status == T3R_OK ? run(runtime) : status;
        if (status != T3R_OK) {
            fprintf(stderr, "%s: %s\n", build, t3r_error_text(status));
            return 1;
        }
        free(arena);
    }
    return 0;
}
