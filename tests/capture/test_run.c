/* SPDX-License-Identifier: Apache-2.0 */
/* A frame's path, from a driver to a recording and to Gaussians, allocates no memory after the start: this program's
 * allocator counts. The live results equal those of the recording's replay, bit for bit. */
#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/mman.h>
#include <time.h>
#include <unistd.h>

#include "capture/capture_adapter.h"
#include "capture/run.h"
#include "capture/v4l2.h"
#include "cli/cli.h"
#include "fake_v4l2.h"
#include "room/room.h"
#include "scratch.h"
#include "test.h"

/* glibc's own allocator, counted; it replaces the whole process's, the C library included */

static volatile uint64_t allocations;

#ifdef __has_feature
#if __has_feature(address_sanitizer)
#define SANITIZED 1
#endif
#endif
#if defined __SANITIZE_ADDRESS__ || defined SANITIZED || !defined __GLIBC__
#define COUNTS 0
#else
#define COUNTS 1
extern void *__libc_malloc(size_t bytes);
extern void *__libc_calloc(size_t count, size_t bytes);
extern void *__libc_realloc(void *memory, size_t bytes);
extern void *__libc_memalign(size_t alignment, size_t bytes);

void *malloc(size_t bytes)
{
    allocations++;
    return __libc_malloc(bytes);
}

void *calloc(size_t count, size_t bytes)
{
    allocations++;
    return __libc_calloc(count, bytes);
}

void *realloc(void *memory, size_t bytes)
{
    allocations++;
    return __libc_realloc(memory, bytes);
}

int posix_memalign(void **memory, size_t alignment, size_t bytes)
{
    allocations++;
    *memory = __libc_memalign(alignment, bytes);
    return *memory != NULL ? 0 : ENOMEM;
}
#endif

/* ---- the room as a camera sees it ---- */

enum { WIDTH = 64, HEIGHT = 48, VIEWS = 4 };

static uint8_t rgb[VIEWS][HEIGHT][WIDTH][3];
static uint16_t depth_mm[VIEWS][HEIGHT][WIDTH];

static int draw_room(void **state)
{
    (void)state;
    for (uint32_t i = 0; i < VIEWS; i++) {
        room_frame(i, WIDTH, HEIGHT, 1, &rgb[i][0][0][0], &depth_mm[i][0][0]);
    }
    return 0;
}

/* Fills samples for each format; their meaning does not matter here. */
static uint32_t fill_colour(void *user, const fake_node *node, uint32_t number, uint8_t *memory)
{
    (void)user;
    uint32_t bytes = fake_image_bytes(node), stride = node->format.bytesperline;
    uint32_t view = number % VIEWS;
    for (uint32_t i = 0; i < bytes; i++) {
        uint32_t x = i % stride % WIDTH, y = i / stride % HEIGHT;
        memory[i] = rgb[view][y][x][i % 3];
    }
    return bytes;
}

static uint32_t fill_depth(void *user, const fake_node *node, uint32_t number, uint8_t *memory)
{
    (void)user;
    for (uint32_t y = 0; y < HEIGHT; y++) {
        for (uint32_t x = 0; x < WIDTH; x++) {
            uint8_t *p = memory + y * node->format.bytesperline + 2 * x;
            p[0] = (uint8_t)depth_mm[number % VIEWS][y][x];
            p[1] = (uint8_t)(depth_mm[number % VIEWS][y][x] >> 8);
        }
    }
    return fake_image_bytes(node);
}

static void start_camera(fake_v4l2 *fake, uint32_t fourcc)
{
    fake_start(fake);
    fake_add_depth(fake);
    for (int i = 0; i < 2; i++) {
        fake->node[i].sizes[0] = (fake_size){WIDTH, HEIGHT, 30};
        fake->node[i].padding = 32;
    }
    fake->node[0].formats[0] = fourcc;
    fake->node[0].fill = fill_colour;
    fake->node[1].fill = fill_depth;
    fake->node[1].first_ns += 3000000;
}

static t3r_capture *open_camera(fake_v4l2 *fake)
{
    t3r_capture_settings wish = {.width = WIDTH, .height = HEIGHT, .depth = "/dev/video2"}, filled;
    char error[256] = "";
    t3r_v4l2_system system = fake_system(fake);
    assert_null(t3r_capture_settings_fill(&wish, &filled));
    t3r_capture *capture = t3r_v4l2_open_on(&system, "/dev/video0", &filled, error, sizeof error);
    if (capture == NULL) {
        fail_msg("%s", error);
    }
    return capture;
}

/* Returns poses on the room's path over the time of the capture, by the camera's own clock. */
static trajectory path_of_room(void)
{
    trajectory t = {.kind = "test", .count = 400};
    t.poses = calloc(t.count, sizeof *t.poses);
    for (uint32_t i = 0; i < t.count; i++) {
        t3r_recorded_camera c;
        room_recorded_camera(i % VIEWS, WIDTH, HEIGHT, &c);
        t.poses[i].stamp_ns = 5000000000 + (int64_t)i * 33333333;
        memcpy(t.poses[i].pose.position, c.position, sizeof c.position);
        memcpy(t.poses[i].pose.rotation, c.rotation, sizeof c.rotation);
    }
    return t;
}

/* ---- tests ---- */

/* Counts the allocations while frames from `from` on arrive; the source knows when capture_run() has begun. */
typedef struct counted_source {
    t3r_capture capture;
    t3r_capture *inner;
    uint32_t delivered, from;
    uint64_t at_start, at_end;
} counted_source;

static int counted_next(t3r_capture *capture, t3r_capture_frame *frame)
{
    counted_source *self = (counted_source *)capture;
    if (self->delivered == self->from) {
        self->at_start = allocations;
    }
    self->at_end = allocations;
    int got = t3r_capture_next(self->inner, frame);
    self->delivered += got == T3R_CAPTURE_FRAME;
    return got;
}

TEST_WITH(nothing_is_allocated_once_it_runs, scratch_setup, scratch_teardown)
{
    if (!COUNTS) {
        skip();
    }
    scratch *s = *state;
    char recording[600], scene[600];
    snprintf(recording, sizeof recording, "%s", scratch_path(s, "a.mcap"));
    snprintf(scene, sizeof scene, "%s", scratch_path(s, "a.ply"));
    static const t3r_capture_operations operations = {counted_next, NULL, NULL};
    fake_v4l2 fake;
    start_camera(&fake, V4L2_PIX_FMT_YUYV);
    fake.node[0].flag_error_at = 20;
    fake.node[1].drop_from = 30;
    fake.node[1].drop_count = 1;
    t3r_capture *camera = open_camera(&fake);
    counted_source source = {.capture = {.operations = &operations, .clock = "monotonic", .depth_unit_q40 = 1099511628},
                             .inner = camera,
                             .from = 1};
    trajectory poses = path_of_room();
    t3r_recorded_camera lens;
    room_recorded_camera(0, WIDTH, HEIGHT, &lens);
    reconstruction_options build;
    reconstruction_defaults(&build);
    build.gaussians = 500;
    build.config.refine = 1;
    const capture_plan plan = {.source = "test",
                               .output = recording,
                               .max_bytes = 400000, /* rolls over during the run */
                               .poses = &poses,
                               .intrinsics = &lens,
                               .frames = 60,
                               .build = &build,
                               .every = 10,
                               .scene = scene,
                               .hash = true,
                               .quiet = true};
    capture_account account;
    assert_int_equal(capture_run(&source.capture, &plan, &account), CLI_OK);
    assert_int_equal(account.frames, 60);
    assert_true(account.files > 1);
    assert_int_equal(account.builds, 5);
    assert_int_equal(account.gaussians, 500);
    assert_true(source.at_start > 0);
    assert_int_equal(source.at_end - source.at_start, 0);
    t3r_capture_close(camera);
    trajectory_free(&poses);
}

TEST(memory_stays_the_same_over_ten_thousand_frames)
{
    if (!COUNTS) {
        skip();
    }
    (void)state;
    fake_v4l2 fake;
    start_camera(&fake, V4L2_PIX_FMT_GREY);
    t3r_capture *capture = open_camera(&fake);
    t3r_capture_frame frame;
    uint64_t before = allocations;
    for (uint32_t i = 0; i < 10000;) {
        int got = t3r_capture_next(capture, &frame);
        assert_true(got == T3R_CAPTURE_FRAME || got == T3R_CAPTURE_NOTHING);
        i += got == T3R_CAPTURE_FRAME;
    }
    assert_int_equal(allocations - before, 0);
    assert_int_equal(t3r_capture_counts_of(capture).paired, 10000);
    t3r_capture_close(capture);
}

TEST_WITH(a_recording_replays_what_was_live, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    static const uint32_t fourccs[] = {V4L2_PIX_FMT_YUYV,  V4L2_PIX_FMT_UYVY,  V4L2_PIX_FMT_NV12,
                                       V4L2_PIX_FMT_RGB24, V4L2_PIX_FMT_BGR24, V4L2_PIX_FMT_GREY};
    for (size_t i = 0; i < sizeof fourccs / sizeof fourccs[0]; i++) {
        char recording[600], error[256] = "";
        snprintf(recording, sizeof recording, "%s", scratch_path(s, "b.mcap"));
        fake_v4l2 fake;
        start_camera(&fake, fourccs[i]);
        fake.node[1].drop_from = 7; /* this colour image has no depth, also in the replay */
        fake.node[1].drop_count = 1;
        t3r_capture *camera = open_camera(&fake);
        trajectory poses = path_of_room();
        t3r_recorded_camera lens;
        room_recorded_camera(0, WIDTH, HEIGHT, &lens);
        reconstruction_options build;
        reconstruction_defaults(&build);
        build.keep_percent = 10;
        build.config.refine = 1;
        build.config.clusters = 60; /* quicker */
        build.context_count = 2;
        build.context[1] = 3;
        capture_plan plan = {.source = "test",
                             .output = recording,
                             .poses = &poses,
                             .intrinsics = &lens,
                             .frames = 100,
                             .build = &build,
                             .hash = true,
                             .quiet = true};
        capture_account live, replayed;
        assert_int_equal(capture_run(camera, &plan, &live), CLI_OK);
        t3r_capture_close(camera);
        t3r_capture *replay = t3r_replay_open(recording, error, sizeof error);
        assert_non_null(replay);
        assert_string_equal(t3r_capture_clock(replay), "monotonic");
        plan.output = NULL;
        plan.poses = NULL;
        plan.intrinsics = NULL;
        assert_int_equal(capture_run(replay, &plan, &replayed), CLI_OK);
        t3r_capture_close(replay);
        assert_int_equal(replayed.frames, 100);
        assert_int_equal(live.counts.paired, 99);
        assert_int_equal(replayed.counts.paired, 99);
        assert_int_equal(replayed.frames_hash, live.frames_hash);
        assert_int_equal(replayed.scene_hash, live.scene_hash);

        /* and `trim3r build` makes the scene that was made live */
        t3r_recording *bag = t3r_recording_open(recording, error, sizeof error);
        assert_non_null(bag);
        /* every pair, the image without depth, and the reason */
        uint64_t told = 0;
        for (uint32_t k = 0; k < t3r_recording_stream_count(bag); k++) {
            t3r_stream_info stream = t3r_recording_stream(bag, k);
            told += strcmp(stream.topic, "/camera/events") == 0 ? stream.messages : 0;
        }
        assert_int_equal(told, 99 + 1 + 1);
        reconstruction r;
        assert_int_equal(reconstruction_build(&r, bag, recording, &build), CLI_OK);
        assert_int_equal(reconstruction_hash(&r), live.scene_hash);
        assert_int_equal(r.scene.count, live.gaussians);
        reconstruction_close(&r);
        t3r_recording_close(bag);
        trajectory_free(&poses);
    }
}

/* The first image has no depth: the first used frame determines the memory for kept frames. */
TEST(a_build_begins_with_the_first_frame_that_it_uses)
{
    for (uint32_t every = 0; every < 2; every++) {
        fake_v4l2 fake;
        start_camera(&fake, V4L2_PIX_FMT_YUYV);
        fake.node[1].drop_from = 0;
        fake.node[1].drop_count = 1;
        t3r_capture *camera = open_camera(&fake);
        trajectory poses = path_of_room();
        t3r_recorded_camera lens;
        room_recorded_camera(0, WIDTH, HEIGHT, &lens);
        reconstruction_options build;
        reconstruction_defaults(&build);
        build.keep_percent = 10;
        build.config.refine = 0;
        build.context_count = every > 0 ? 0 : 2;
        build.context[0] = 1;
        build.context[1] = 3;
        const capture_plan plan = {.source = "test",
                                   .poses = &poses,
                                   .intrinsics = &lens,
                                   .frames = 6,
                                   .build = &build,
                                   .every = every * 2,
                                   .quiet = true};
        capture_account account;
        assert_int_equal(capture_run(camera, &plan, &account), CLI_OK);
        assert_int_equal(account.counts.paired, 5);
        assert_int_equal(account.builds, every > 0 ? 2 : 1);
        assert_true(account.arena_bytes > 0);
        t3r_capture_close(camera);
        trajectory_free(&poses);
    }
}

/* Only the rows of a frame are read: memory after the last row's samples faults. */
TEST(kept_frames_are_read_by_their_rows)
{
    enum { STRIDE = WIDTH * 3 + 32, BYTES = STRIDE * (HEIGHT - 1) + WIDTH * 3 };
    size_t page = (size_t)sysconf(_SC_PAGESIZE), whole = (BYTES + page - 1) / page * page;
    uint8_t *memory = mmap(NULL, whole + page, PROT_READ | PROT_WRITE, MAP_PRIVATE | MAP_ANONYMOUS, -1, 0);
    assert_ptr_not_equal(memory, MAP_FAILED);
    assert_int_equal(mprotect(memory + whole, page, PROT_NONE), 0);
    uint8_t *picture = memory + whole - BYTES;
    for (uint32_t i = 0; i < BYTES; i++) {
        picture[i] = (uint8_t)(i * 7);
    }
    const t3r_capture_frame frame = {.frame = {.format = T3R_PIXEL_RGB24,
                                               .width = WIDTH,
                                               .height = HEIGHT,
                                               .planes = {picture},
                                               .stride_bytes = {STRIDE},
                                               .depth = (const uint8_t *)depth_mm,
                                               .depth_width = WIDTH,
                                               .depth_height = HEIGHT,
                                               .depth_stride_bytes = WIDTH * 2,
                                               .depth_unit_q40 = T3R_DEFAULT_DEPTH_UNIT_Q40}};
    reconstruction_options options;
    reconstruction_defaults(&options);
    options.gaussians = 100;
    live_build build;
    assert_int_equal(live_build_open(&build, &options, 2, &frame), CLI_OK);
    assert_int_equal(live_build_keep(&build, &frame), CLI_OK);
    const t3r_frame *kept = &build.kept[0].frame.frame;
    for (uint32_t y = 0; y < HEIGHT; y++) {
        assert_memory_equal(kept->planes[0] + (size_t)y * kept->stride_bytes[0], picture + (size_t)y * STRIDE,
                            WIDTH * 3);
    }
    assert_memory_equal(kept->depth, depth_mm, (size_t)WIDTH * HEIGHT * 2);
    live_build_close(&build);
    munmap(memory, whole + page);
}

/* A replay reports no latency between a frame's stamp and its arrival, however recent the recording is. */
TEST_WITH(a_replay_has_no_latency, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    char recording[600], error[256] = "";
    snprintf(recording, sizeof recording, "%s", scratch_path(s, "d.mcap"));
    struct timespec now;
    clock_gettime(CLOCK_MONOTONIC, &now);
    fake_v4l2 fake;
    start_camera(&fake, V4L2_PIX_FMT_GREY);
    fake.now_ns = fake.node[0].first_ns = fake.node[1].first_ns = ((int64_t)now.tv_sec - 5) * 1000000000;
    t3r_capture *camera = open_camera(&fake);
    capture_plan plan = {.source = "test", .output = recording, .frames = 20, .quiet = true};
    capture_account live, replayed;
    assert_int_equal(capture_run(camera, &plan, &live), CLI_OK);
    t3r_capture_close(camera);
    assert_int_equal(live.late.count, 20);
    t3r_capture *replay = t3r_replay_open(recording, error, sizeof error);
    assert_non_null(replay);
    assert_string_equal(t3r_capture_clock(replay), "monotonic");
    plan.output = NULL;
    assert_int_equal(capture_run(replay, &plan, &replayed), CLI_OK);
    t3r_capture_close(replay);
    assert_int_equal(replayed.frames, 20);
    assert_int_equal(replayed.late.count, 0);
}

/* A recording repeated until its clock is full ends with a reason; no stamp goes back. */
TEST_WITH(a_repeated_recording_ends_with_its_clock, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    char recording[600], error[256] = "";
    snprintf(recording, sizeof recording, "%s", scratch_path(s, "e.mcap"));
    static const int64_t span_ns = 500000000000000000;
    t3r_capture_frame frame = {.frame = {.format = T3R_PIXEL_RGB24,
                                         .width = WIDTH,
                                         .height = HEIGHT,
                                         .planes = {&rgb[0][0][0][0]},
                                         .stride_bytes = {WIDTH * 3}}};
    static capture_record record;
    assert_int_equal(
        capture_record_begin(&record, recording, 0, false, "test", "monotonic", 1099511628, &(recording_options){0}),
        0);
    for (int i = 0; i < 2; i++) {
        frame.stamp_ns = frame.depth_stamp_ns = 1000 + i * span_ns;
        assert_int_equal(capture_record_frame(&record, &frame), 0);
    }
    assert_int_equal(capture_record_end(&record), 0);
    t3r_capture *replay = t3r_replay_open_repeated(recording, UINT32_MAX, error, sizeof error);
    assert_non_null(replay);
    for (int i = 0; i < 6; i++) { /* a fourth turn would start at 3e18 ns, beyond 2^61 */
        assert_int_equal(t3r_capture_next(replay, &frame), T3R_CAPTURE_FRAME);
        assert_int_equal(frame.stamp_ns, 1000 + i * span_ns);
    }
    assert_int_equal(t3r_capture_next(replay, &frame), T3R_CAPTURE_FAILED);
    assert_non_null(strstr(t3r_capture_error(replay), "the clock does not hold"));
    assert_int_equal(t3r_capture_next(replay, &frame), T3R_CAPTURE_END);
    t3r_capture_close(replay);
}

/* A camera that never gives a frame, although it is reopened again and again, is finally given up, and the recording
 * is complete. */
TEST_WITH(a_camera_that_stands_still_for_good_is_given_up, scratch_setup, scratch_teardown)
{
    scratch *s = *state;
    char recording[600], error[256] = "", message[256] = "";
    snprintf(recording, sizeof recording, "%s", scratch_path(s, "c.mcap"));
    fake_v4l2 fake;
    start_camera(&fake, V4L2_PIX_FMT_YUYV);
    fake.node[0].stall_at = fake.node[1].stall_at = 5;
    fake.node[0].stays = fake.node[1].stays = true;
    t3r_capture *camera = open_camera(&fake);
    const capture_plan plan = {.source = "test", .output = recording, .quiet = true, .reconnect_seconds = 0.05};
    capture_account account;
    cli_keep_errors(message, sizeof message);
    assert_int_equal(capture_run(camera, &plan, &account), CLI_BAD_INPUT);
    cli_keep_errors(NULL, 0);
    assert_non_null(strstr(message, "not back within 0.05 s"));
    assert_int_equal(account.frames, 5);
    t3r_capture_close(camera);
    t3r_recording *bag = t3r_recording_open(recording, error, sizeof error);
    assert_non_null(bag);
    assert_int_equal(t3r_recording_frame_count(bag), 5);
    assert_string_equal(t3r_recording_note(bag), "");
    t3r_recording_close(bag);
}

ALL_TESTS_WITH(draw_room, NULL)
