/* SPDX-License-Identifier: Apache-2.0 */
/* Builds the built-in room and draws a view of each build, in plain C on one thread. callgrind writes each stage's
 * instructions as a separate part, named by the build and the stage. An argument is a build:
 * NAME,WIDTH,HEIGHT,VIEWS,GAUSSIANS,HEAD,DEPTH,CLUSTERS,BATCHES,PASSES. Prints a line of work for each: the name, and
 * KIND=UNITS. */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <valgrind/callgrind.h>

#include "planning/work.h"
#include "rgbd_frame.h"
#include "room/room.h"
#include "trim3r.h"
#include "trim3r_heads.h"

enum { SEED = 1 };

typedef struct build {
    char name[32], head[16], depth[16];
    t3r_config config;
    const uint8_t *weights;
    uint32_t weight_bytes;
    uint8_t *rgb, *depth_bytes, *view;
    uint16_t *depth_mm;
} build;

static const char *current; /* name of the current build */

/* Assigns the instructions since the last part to that stage. */
static void end_stage(void *user, t3r_stage stage, uint64_t hash)
{
    char name[64];
    (void)user;
    (void)hash;
    snprintf(name, sizeof name, "%s %s", current, t3r_stage_name(stage));
    CALLGRIND_DUMP_STATS_AT(name);
    CALLGRIND_ZERO_STATS;
}

static bool read_build(const char *text, build *b)
{
    uint32_t width, height, views, gaussians, clusters, batches, passes;
    if (sscanf(text,
               "%31[^,],%" SCNu32 ",%" SCNu32 ",%" SCNu32 ",%" SCNu32 ",%15[^,],%15[^,],%" SCNu32 ",%" SCNu32
               ",%" SCNu32,
               b->name, &width, &height, &views, &gaussians, b->head, b->depth, &clusters, &batches, &passes) != 10) {
        return false;
    }
    const struct {
        const char *name;
        const uint8_t *weights;
        uint32_t bytes;
    } networks[] = {{"tiny", t3r_head_tiny, t3r_head_tiny_bytes}, {"small", t3r_head_small, t3r_head_small_bytes}};
    b->config = t3r_default_config(width, height, views, gaussians);
    b->config.clusters = clusters;
    b->config.cluster_batches = batches;
    b->config.refine = passes;
    b->config.depth = strcmp(b->depth, "stereo") == 0 ? T3R_DEPTH_STEREO : T3R_DEPTH_SENSOR;
    for (size_t i = 0; i < sizeof networks / sizeof networks[0]; i++) {
        if (strcmp(b->head, networks[i].name) == 0) {
            b->config.head = T3R_HEAD_LEARNED;
            b->weights = networks[i].weights;
            b->weight_bytes = networks[i].bytes;
        }
    }
    return true;
}

static bool allocate(build *b)
{
    const size_t pixels = (size_t)b->config.width * b->config.height;
    b->rgb = malloc(pixels * 3);
    b->view = malloc(pixels * 3);
    b->depth_bytes = malloc(pixels * 2);
    b->depth_mm = malloc(pixels * 2);
    return b->rgb != NULL && b->view != NULL && b->depth_bytes != NULL && b->depth_mm != NULL;
}

static t3r_status add_frame(const build *b, t3r_runtime *runtime, uint32_t index)
{
    const uint32_t width = b->config.width, height = b->config.height;
    t3r_camera camera;
    room_camera(index, width, height, &camera);
    room_frame(index, width, height, SEED, b->rgb, b->depth_mm);
    for (uint32_t i = 0; i < width * height; i++) {
        b->depth_bytes[2 * i] = (uint8_t)(b->depth_mm[i] & 255);
        b->depth_bytes[2 * i + 1] = (uint8_t)(b->depth_mm[i] >> 8);
    }
    const t3r_frame frame = rgbd_frame(b->rgb, b->depth_bytes, width, height, ROOM_DEPTH_UNIT_Q40);
    CALLGRIND_ZERO_STATS;
    const t3r_status status = t3r_add_view(runtime, &frame, &camera);
    end_stage(NULL, T3R_STAGE_IMAGE, 0);
    return status;
}

static t3r_status run(const build *b, t3r_runtime *runtime)
{
    t3r_scene scene;
    t3r_camera camera;
    const t3r_target target = {
        .width = b->config.width, .height = b->config.height, .rgb = b->view, .rgb_stride_bytes = 3 * b->config.width};
    t3r_status status = T3R_OK;
    for (uint32_t v = 0; v < b->config.views && status == T3R_OK; v++) {
        status = add_frame(b, runtime, 2 * v);
    }
    CALLGRIND_ZERO_STATS;
    status = status == T3R_OK ? t3r_reconstruct(runtime, NULL, &scene) : status;
    room_camera(1, b->config.width, b->config.height, &camera);
    CALLGRIND_ZERO_STATS;
    status = status == T3R_OK ? t3r_render(runtime, &camera, &target) : status;
    end_stage(NULL, T3R_STAGE_RASTER, 0); /* the rest of drawing, which calls no hook */
    return status;
}

static t3r_status print_work(const build *b, size_t bytes)
{
    work_counts work;
    const t3r_status status = work_count(&b->config, bytes, b->weights, &work);
    printf("%s", b->name);
    for (int kind = 0; kind < WORK_KIND_COUNT && status == T3R_OK; kind++) {
        printf(" %s=%" PRIu64, work_name((work_kind)kind), work.units[kind]);
    }
    printf(" operations=%.0f\n", work_price_of_build(&work, &work_operations));
    return status;
}

static t3r_status build_one(build *b)
{
    t3r_plan_info plan;
    t3r_runtime *runtime;
    void *arena;
    t3r_status status = t3r_plan(&b->config, &plan);
    if (status != T3R_OK || !allocate(b) || posix_memalign(&arena, T3R_ARENA_ALIGN, plan.bytes) != 0) {
        return status != T3R_OK ? status : T3R_ERR_ARENA;
    }
    const t3r_hooks hooks = {.stage_hash = end_stage};
    status = print_work(b, plan.bytes);
    status = status == T3R_OK ? t3r_init(&runtime, arena, plan.bytes, &b->config) : status;
    status = status == T3R_OK ? t3r_set_hooks(runtime, &hooks) : status;
    if (status == T3R_OK && b->weights != NULL) {
        status = t3r_bind_head(runtime, b->weights, b->weight_bytes);
    }
    status = status == T3R_OK ? run(b, runtime) : status;
    free(arena);
    free(b->rgb);
    free(b->view);
    free(b->depth_bytes);
    free(b->depth_mm);
    return status;
}

int main(int argc, char **argv)
{
    for (int i = 1; i < argc; i++) {
        build b = {.weights = NULL};
        const bool good = read_build(argv[i], &b);
        current = b.name;
        const t3r_status status = good ? build_one(&b) : T3R_ERR_ARGUMENT;
        if (status != T3R_OK) {
            fprintf(stderr, "%s: %s\n", argv[i], t3r_error_text(status));
            return 1;
        }
    }
    return 0;
}
