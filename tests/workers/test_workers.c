/* SPDX-License-Identifier: Apache-2.0 */
/* Builds and views of the built-in room by threads, and by tasks in reverse order with alternating workers: each stage
 * has its hash with one worker. */
#include "rgbd_frame.h"
#include "sanitized_cpu.h"
#include "unit/unit.h"

#include "room/room.h"
#include "trim3r_heads.h"
#include "trim3r_host.h"

enum { WIDTH = 88, HEIGHT = 72, VIEWS = 3, BUDGET = VIEWS * WIDTH * HEIGHT / 8, KEYFRAMES = 4 };

typedef struct frame_memory {
    uint8_t rgb[WIDTH * HEIGHT * 3];
    uint8_t depth[WIDTH * HEIGHT * 2];
    t3r_camera camera;
    t3r_frame frame;
} frame_memory;

static frame_memory frames[KEYFRAMES];

/* Hashed stages, and the results, one after the other. */
typedef struct trace {
    uint32_t count;
    t3r_stage stage[256];
    uint64_t hash[256];
} trace;

typedef struct way {
    uint32_t workers;
    bool threads; /* else: reversed, workers in turn */
    bool least;   /* the smallest arena */
} way;

typedef struct host {
    trace seen;
    uint32_t workers;
    t3r_threads *pool;
} host;

static int draw_frames(void **state)
{
    (void)state;
    static uint16_t depth_mm[WIDTH * HEIGHT];
    for (uint32_t v = 0; v < KEYFRAMES; v++) {
        frame_memory *m = &frames[v];
        room_camera(v, WIDTH, HEIGHT, &m->camera);
        room_frame(v, WIDTH, HEIGHT, 1, m->rgb, depth_mm);
        for (uint32_t i = 0; i < WIDTH * HEIGHT; i++) {
            bool hole = (i % WIDTH) / 9 % 4 == 1 && i / WIDTH % 11 < 4; /* some wide, some narrow */
            m->depth[2 * i] = (uint8_t)(hole ? 0 : depth_mm[i]);
            m->depth[2 * i + 1] = (uint8_t)(hole ? 0 : depth_mm[i] >> 8);
        }
        m->frame = rgbd_frame(m->rgb, m->depth, WIDTH, HEIGHT, MILLIMETRE_Q40);
    }
    return 0;
}

static void note_hash(void *user, t3r_stage stage, uint64_t hash)
{
    trace *seen = &((host *)user)->seen;
    assert_true(seen->count < 256);
    seen->stage[seen->count] = stage;
    seen->hash[seen->count++] = hash;
}

static void in_reverse(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                       void *context)
{
    const host *h = user;
    while (count-- > 0) {
        task(context, count, (count + 1) % h->workers);
    }
}

static void by_threads(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                       void *context)
{
    t3r_threads_run(((host *)user)->pool, count, task, context);
}

static t3r_runtime *open_runtime(t3r_config config, const way *w, host *h, void **memory)
{
    config.workers = w->workers;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
    const size_t bytes = w->least ? plan.min_bytes : plan.bytes;
    *memory = aligned_alloc(T3R_ARENA_ALIGN, bytes / T3R_ARENA_ALIGN * T3R_ARENA_ALIGN);
    memset(*memory, 0xa5, bytes); /* unwritten memory must not be read */
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, *memory, bytes, &config), T3R_OK);
    vectors_if_sanitized(rt);
    *h = (host){.workers = w->workers, .pool = w->threads ? t3r_threads_start(w->workers) : NULL};
    const t3r_hooks hooks = {.user = h, .stage_hash = note_hash, .parallel_for = w->threads ? by_threads : in_reverse};
    assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
    if (config.head == T3R_HEAD_LEARNED) {
        assert_int_equal(t3r_bind_head(rt, t3r_head_small, t3r_head_small_bytes), T3R_OK);
    }
    return rt;
}

static void draw(t3r_runtime *rt)
{
    static uint8_t rgb[WIDTH * HEIGHT * 3];
    static uint32_t depth_q20[WIDTH * HEIGHT];
    const t3r_target target = {.width = WIDTH,
                               .height = HEIGHT,
                               .rgb = rgb,
                               .rgb_stride_bytes = WIDTH * 3,
                               .depth_q20 = depth_q20,
                               .depth_stride_bytes = WIDTH * 4};
    assert_int_equal(t3r_render(rt, &frames[1].camera, &target), T3R_OK); /* hashed as stage raster */
}

static trace build(t3r_config config, const way *w)
{
    host h;
    void *memory;
    t3r_runtime *rt = open_runtime(config, w, &h, &memory);
    if (config.stream) {
        for (uint32_t v = 0; v < KEYFRAMES; v++) {
            assert_int_equal(t3r_stream_keyframe(rt, &frames[v].frame, &frames[v].camera, NULL), T3R_OK);
        }
    } else {
        for (uint32_t v = 0; v < config.views; v++) {
            assert_int_equal(t3r_add_view(rt, &frames[v].frame, &frames[v].camera), T3R_OK);
        }
        t3r_scene scene;
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    }
    draw(rt);
    t3r_threads_stop(h.pool);
    free(memory);
    return h.seen;
}

static void check_ways(const t3r_config *config)
{
    static const way ways[] = {
        {2, true, false}, {3, true, true},
#ifndef __SANITIZE_THREAD__ /* finds races of two threads as well, but is slow */
        {8, true, false}, {2, false, false}, {3, false, true}, {8, false, false},
#endif
    };
    const trace alone = build(*config, &(way){1, false, false});
    assert_true(alone.count >= 8);
    for (size_t i = 0; i < sizeof ways / sizeof ways[0]; i++) {
        const trace seen = build(*config, &ways[i]);
        assert_int_equal(seen.count, alone.count);
        for (uint32_t k = 0; k < seen.count; k++) {
            if (seen.hash[k] != alone.hash[k]) {
                fail_msg("stage %s has other bits with %u workers%s", t3r_stage_name(seen.stage[k]), ways[i].workers,
                         ways[i].threads ? " on threads" : ", reversed");
            }
        }
    }
}

static t3r_config settings(t3r_head head)
{
    t3r_config config = t3r_default_config(WIDTH, HEIGHT, VIEWS, BUDGET);
    config.clusters = 40;
    config.refine = 2;
    config.head = head;
    return config;
}

TEST(heads)
{
    static const t3r_head all[] = {T3R_HEAD_ANALYTIC, T3R_HEAD_LEARNED};
    for (size_t i = 0; i < sizeof all / sizeof all[0]; i++) {
        const t3r_config config = settings(all[i]);
        check_ways(&config);
    }
}

/* One view: fewer views than workers. */
TEST(single_view)
{
    t3r_config config = settings(T3R_HEAD_LEARNED);
    config.views = 1;
    check_ways(&config);
}

/* Few Gaussians: wide splats, which reach over several bands of tiles, more than their room holds. */
TEST(wide_splats)
{
    t3r_config config = settings(T3R_HEAD_ANALYTIC);
    config.max_gaussians = config.gaussians = 120;
    check_ways(&config);
}

TEST(stereo)
{
    t3r_config config = settings(T3R_HEAD_ANALYTIC);
    config.depth = T3R_DEPTH_STEREO;
    check_ways(&config);
}

TEST(stream)
{
    t3r_config config = settings(T3R_HEAD_LEARNED);
    config.stream = 1;
    check_ways(&config);
}

ALL_TESTS_WITH(draw_frames, NULL)
