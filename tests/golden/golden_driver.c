/* SPDX-License-Identifier: Apache-2.0 */
/* Runs the whole runtime over the built-in room in several configurations and prints every stage's hash:
 * "configuration stage hash". It uses the runtime, the room and a shipped head alone, so that it builds wherever
 * they do.
 *
 * Options vary everything without influence: --arena min|full|ten, --tasks plain|reverse, --workers 1..8 of those
 * tasks,
 * --moved (the arena is copied to another place and attached again between any two calls). */
#include <inttypes.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "core/hash.h"
#include "host/cpu.h"
#include "room/room.h"
#include "state/ablation.h"
#include "trim3r.h"
#include "trim3r_heads.h"
#include "weights_maker.h"

enum { MOST_WIDTH = 128, MOST_HEIGHT = 96, MOST_PIXELS = MOST_WIDTH * MOST_HEIGHT, CONTEXT_VIEWS = 2, TARGET_VIEW = 1 };

typedef struct configuration {
    const char *name;
    uint32_t frame_width, frame_height; /* captured */
    uint32_t width, height;             /* working */
    t3r_pixel_format format;
    t3r_distortion distortion;
    t3r_wavelet wavelet;
    uint32_t levels, clusters; /* 0: chosen by the number of points */
    t3r_allocation allocate;
    t3r_head head;
    uint32_t gaussians;
    bool holes;
    uint32_t bits; /* bits of a made-up learned head's weights and activations; 0: the shipped head, or none */
    t3r_depth depth;
    bool unadapted; /* splats as small as pixels */
    bool displaced; /* all views but the first have wrong poses, which alignment corrects */
    bool squares;   /* all views but the first are brighter and darker in squares, so that passes compare a part */
} configuration;

static const configuration configurations[] = {
    {"default", 128, 96, 96, 96, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 0, T3R_ALLOCATE_DENSITY,
     T3R_HEAD_ANALYTIC, 1843, false, 0, T3R_DEPTH_SENSOR, false, false, false},
    {"small", 128, 96, 61, 45, T3R_PIXEL_GREY, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 3, 17, T3R_ALLOCATE_DENSITY,
     T3R_HEAD_ANALYTIC, 700, true, 0, T3R_DEPTH_SENSOR, false, false, false},
    {"haar_paper", 128, 96, 64, 48, T3R_PIXEL_YUYV, T3R_DISTORTION_NONE, T3R_WAVELET_HAAR, 1, 32, T3R_ALLOCATE_PAPER,
     T3R_HEAD_ANALYTIC, 3000, true, 0, T3R_DEPTH_SENSOR, false, false, false},
    {"cdf53_pixel", 128, 96, 64, 48, T3R_PIXEL_NV12, T3R_DISTORTION_RADTAN, T3R_WAVELET_CDF53, 4, 300,
     T3R_ALLOCATE_PIXEL, T3R_HEAD_ANALYTIC, 600, true, 0, T3R_DEPTH_SENSOR, false, false, false},
    {"uniform", 128, 96, 64, 48, T3R_PIXEL_BGR24, T3R_DISTORTION_FISHEYE, T3R_WAVELET_DB2, 2, 0, T3R_ALLOCATE_UNIFORM,
     T3R_HEAD_ANALYTIC, 600, true, 0, T3R_DEPTH_SENSOR, false, false, false},
    {"random", 128, 96, 64, 48, T3R_PIXEL_UYVY, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 0, T3R_ALLOCATE_RANDOM,
     T3R_HEAD_ANALYTIC, 600, false, 0, T3R_DEPTH_SENSOR, true, false, false},
    {"everything", 96, 96, 96, 96, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 64, T3R_ALLOCATE_DENSITY,
     T3R_HEAD_ANALYTIC, CONTEXT_VIEWS * 96 * 96, false, 0, T3R_DEPTH_SENSOR, false, false, false},
    {"learned", 128, 96, 61, 45, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 64, T3R_ALLOCATE_DENSITY,
     T3R_HEAD_LEARNED, 700, true, 8, T3R_DEPTH_SENSOR, false, false, false},
    {"learned_wide", 128, 96, 64, 48, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 64,
     T3R_ALLOCATE_DENSITY, T3R_HEAD_LEARNED, 600, true, 16, T3R_DEPTH_SENSOR, false, false, false},
    {"shipped", 128, 96, 91, 77, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 64, T3R_ALLOCATE_DENSITY,
     T3R_HEAD_LEARNED, 1400, true, 0, T3R_DEPTH_SENSOR, false, false, false},
    {"given", 128, 96, 61, 45, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 64, T3R_ALLOCATE_GIVEN,
     T3R_HEAD_LEARNED, 700, true, 8, T3R_DEPTH_SENSOR, false, false, false},
    {"stereo", 128, 96, 96, 83, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 0, T3R_ALLOCATE_DENSITY,
     T3R_HEAD_LEARNED, 1400, false, 0, T3R_DEPTH_STEREO, false, false, false},
    {"aligned", 128, 96, 91, 77, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 64, T3R_ALLOCATE_DENSITY,
     T3R_HEAD_ANALYTIC, 1400, true, 0, T3R_DEPTH_SENSOR, false, true, false},
    {"parts", 128, 96, 96, 96, T3R_PIXEL_RGB24, T3R_DISTORTION_NONE, T3R_WAVELET_DB2, 2, 64, T3R_ALLOCATE_DENSITY,
     T3R_HEAD_ANALYTIC, 300, false, 0, T3R_DEPTH_SENSOR, false, false, true},
};

typedef enum arena_size { ARENA_MIN, ARENA_FULL, ARENA_TEN } arena_size;

typedef struct variation {
    arena_size arena;
    bool reverse_tasks;
    uint32_t workers;
    uint32_t cpu; /* T3R_CPU_...: features whose kernels are used */
    bool moved;
} variation;

/* Ten times the largest configuration's arena; two arenas, so that one can move to the other. */
enum {
    ARENA_ROOM =
        10 * T3R_FULL_BYTES_(T3R_SHAPE_(96, 96, 2, 2 * 96 * 96, 300, 96, 96, T3R_HEAD_COLUMN_BYTES, 1, 4, 1, 1, 0, 0))
};
static _Alignas(T3R_ARENA_ALIGN) uint8_t arenas[2][ARENA_ROOM];

/* ---- the frames ---------------------------------------------------------------------------------------- */

static uint8_t rgb[MOST_PIXELS * 3], planes[2][MOST_PIXELS * 3], depth_bytes[MOST_PIXELS * 2];
static uint16_t depth_mm[MOST_PIXELS];

static int level(int value)
{
    return value < 0 ? 0 : value > 255 ? 255 : value;
}

/* Any deterministic coding will do: both sides of every comparison use this one. */
static void luma_and_chroma(const uint8_t *pixel, uint8_t *y, uint8_t *u, uint8_t *v)
{
    int r = pixel[0], g = pixel[1], b = pixel[2];
    *y = (uint8_t)level(16 + (66 * r + 129 * g + 25 * b + 128) / 256);
    *u = (uint8_t)level(128 + (112 * b - 38 * r - 74 * g) / 256);
    *v = (uint8_t)level(128 + (112 * r - 94 * g - 18 * b) / 256);
}

/* Converts the room's colours to the camera's pixel format. */
static void encode(t3r_frame *frame)
{
    uint32_t width = frame->width, height = frame->height;
    frame->planes[0] = planes[0];
    frame->planes[1] = planes[1];
    for (uint32_t i = 0; i < width * height; i++) {
        uint32_t x = i % width, row = i / width;
        const uint8_t *pixel = rgb + 3 * i;
        uint8_t y, u, v;
        luma_and_chroma(pixel, &y, &u, &v);
        switch (frame->format) {
        case T3R_PIXEL_RGB24:
            memcpy(planes[0] + 3 * i, pixel, 3);
            break;
        case T3R_PIXEL_BGR24:
            planes[0][3 * i] = pixel[2];
            planes[0][3 * i + 1] = pixel[1];
            planes[0][3 * i + 2] = pixel[0];
            break;
        case T3R_PIXEL_GREY:
            planes[0][i] = y;
            break;
        case T3R_PIXEL_YUYV:
            planes[0][2 * i] = y;
            planes[0][2 * i + 1] = x % 2 == 0 ? u : v;
            break;
        case T3R_PIXEL_UYVY:
            planes[0][2 * i + 1] = y;
            planes[0][2 * i] = x % 2 == 0 ? u : v;
            break;
        case T3R_PIXEL_NV12:
            planes[0][i] = y;
            if (row % 2 == 0) {
                planes[1][row / 2 * width + x] = x % 2 == 0 ? u : v;
            }
            break;
        case T3R_PIXEL_FORMAT_COUNT:
            break;
        }
    }
    bool two_bytes = frame->format == T3R_PIXEL_YUYV || frame->format == T3R_PIXEL_UYVY;
    bool three_bytes = frame->format == T3R_PIXEL_RGB24 || frame->format == T3R_PIXEL_BGR24;
    frame->stride_bytes[0] = width * (three_bytes ? 3 : two_bytes ? 2 : 1);
    frame->stride_bytes[1] = width;
}

/* Depth like a sensor's: single pixels, small blobs and one large area without a measurement. */
static void encode_depth(t3r_frame *frame, bool holes)
{
    uint32_t width = frame->width, height = frame->height;
    for (uint32_t i = 0; i < width * height; i++) {
        uint32_t x = i % width, y = i / width;
        bool missing = i % 37 == 0 || (x / 3 * 7 + y / 3 * 5) % 23 == 0 || (x < width / 5 && y > height / 2);
        uint16_t step = holes && missing ? 0 : depth_mm[i];
        depth_bytes[2 * i] = (uint8_t)(step & 255);
        depth_bytes[2 * i + 1] = (uint8_t)(step >> 8);
    }
    frame->depth = depth_bytes;
    frame->depth_width = width;
    frame->depth_height = height;
    frame->depth_stride_bytes = 2 * width;
    frame->depth_unit_q40 = ROOM_DEPTH_UNIT_Q40;
}

/* Puts a lens on the room's pinhole pictures: they show no true distortion, but take every path of the undistortion. */
static void put_lens(t3r_camera *camera, t3r_distortion distortion)
{
    static const int32_t coefficients_q24[T3R_DISTORTION_COUNT][5] = {
        {0}, {-1200000, 260000, 9000, -7000, -30000}, {-500000, 90000, -20000, 4000, 0}};
    camera->distortion = distortion;
    memcpy(camera->distortion_q24, coefficients_q24[distortion], sizeof camera->distortion_q24);
}

/* ---- the run ------------------------------------------------------------------------------------------- */

typedef struct run {
    const configuration *configuration;
    variation ways;
    const char *step; /* "add_view", "reconstruct", ... */
    t3r_runtime *rt;
    size_t arena_bytes;
    uint32_t here;          /* index of the arena that holds the state */
    const uint8_t *weights; /* NULL except for the learned head */
    uint8_t *made;          /* made up; to be freed */
    size_t weights_bytes;
} run;

static void print_hash(const run *r, const char *what, uint64_t hash)
{
    printf("%s %s %s %016" PRIx64 "\n", r->configuration->name, r->step, what, hash);
}

static void on_stage_hash(void *user, t3r_stage stage, uint64_t hash)
{
    print_hash(user, t3r_stage_name(stage), hash);
}

/* Runs the last task first, by the workers in turn: results must not depend on the order, or on one worker running
 * all. */
static void run_in_reverse(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                           void *context)
{
    const run *r = user;
    while (count-- > 0) {
        task(context, count, (count + 1) % r->ways.workers);
    }
}

static int failed(const run *r, t3r_status status)
{
    fprintf(stderr, "%s: %s: %s\n", r->configuration->name, r->step, t3r_error_text(status));
    return 1;
}

/* Names the step; moves the arena when asked; binds the hooks and the weights. */
static t3r_status begin_step(run *r, const char *step)
{
    r->step = step;
    if (r->ways.moved) {
        memcpy(arenas[1 - r->here], arenas[r->here], r->arena_bytes);
        memset(arenas[r->here], 0x5a, r->arena_bytes);
        r->here = 1 - r->here;
        t3r_status status = t3r_attach(&r->rt, arenas[r->here], r->arena_bytes);
        if (status != T3R_OK) {
            return status;
        }
    }
    t3r_status status = t3r_bind_head(r->rt, r->weights, r->weights_bytes);
    if (status == T3R_OK) {
        status = t3r_set_cpu(r->rt, r->ways.cpu);
    }
    if (status != T3R_OK) {
        return status;
    }
    t3r_hooks hooks = {.user = r, .stage_hash = on_stage_hash};
    hooks.parallel_for = r->ways.reverse_tasks ? run_in_reverse : NULL;
    return t3r_set_hooks(r->rt, &hooks);
}

static t3r_status begin_run(run *r, bool stream)
{
    const configuration *c = r->configuration;
    t3r_config config = t3r_default_config(c->width, c->height, CONTEXT_VIEWS, c->gaussians);
    config.stream = stream;
    config.wavelet = c->wavelet;
    config.levels = c->levels;
    config.clusters = c->clusters;
    config.allocate = c->allocate;
    config.head = c->head;
    config.depth = c->depth;
    config.keep_analysis = 1;
    config.workers = r->ways.workers;
    if (c->bits != 0) {
        r->weights = r->made = make_weights(small_shape, small_layers, c->bits, c->bits, 1, &r->weights_bytes);
    } else if (c->head == T3R_HEAD_LEARNED) {
        r->weights = t3r_head_small;
        r->weights_bytes = t3r_head_small_bytes;
    }
    if (r->weights != NULL) {
        config.head_column_bytes = t3r_head_column_bytes(r->weights, r->weights_bytes, config.width);
    }
    t3r_plan_info plan;
    r->step = "plan";
    t3r_status status = t3r_plan(&config, &plan);
    if (status != T3R_OK) {
        return status;
    }
    r->arena_bytes = r->ways.arena == ARENA_MIN ? plan.min_bytes : plan.bytes * (r->ways.arena == ARENA_TEN ? 10 : 1);
    if (r->arena_bytes > sizeof arenas[0]) {
        return T3R_ERR_ARENA;
    }
    /* the memory's earlier contents must not matter either */
    memset(arenas[0], r->ways.arena == ARENA_MIN ? 0xff : 0, r->arena_bytes);
    r->here = 0;
    r->step = "init";
    status = t3r_init(&r->rt, arenas[0], r->arena_bytes, &config);
    if (status == T3R_OK) {
        status = t3r_set_cpu(r->rt, r->ways.cpu);
    }
    return status == T3R_OK ? t3r_set_ablation(r->rt, &(t3r_ablation){.unadapted = c->unadapted}) : status;
}

/* Makes the room's colours brighter and darker in turn, in squares of 16 pixels. */
static void paint_squares(uint32_t width, uint32_t height)
{
    for (uint32_t i = 0; i < 3 * width * height; i++) {
        const uint32_t pixel = i / 3, square = pixel % width / 16 + pixel / width / 16;
        rgb[i] = (uint8_t)level(rgb[i] + (square % 2 == 0 ? 40 : -40));
    }
}

/* Makes frame `index` of the room as the configuration's camera captures it. */
static void capture(const configuration *c, uint32_t index, t3r_frame *frame, t3r_camera *camera)
{
    *frame = (t3r_frame){.format = c->format, .width = c->frame_width, .height = c->frame_height};
    room_frame(index, frame->width, frame->height, 1, rgb, depth_mm);
    if (c->squares && index > 0) {
        paint_squares(frame->width, frame->height);
    }
    room_camera(index, frame->width, frame->height, camera);
    camera->position_q32[0] += c->displaced && index > 0 ? INT64_C(1) << 27 : 0; /* 1/32 m */
    encode(frame);
    encode_depth(frame, c->holes);
    put_lens(camera, c->distortion);
}

static t3r_status add_view(run *r, uint32_t index)
{
    t3r_frame frame;
    t3r_camera camera;
    capture(r->configuration, index, &frame, &camera);
    t3r_status status = begin_step(r, "add_view");
    return status == T3R_OK ? t3r_add_view(r->rt, &frame, &camera) : status;
}

/* Builds with importances in blobs, with ties; one plane for both views; rows have a gap. */
static t3r_status build(run *r, uint32_t rebudgeted, t3r_scene *scene)
{
    enum { GAP = 3 };
    static uint16_t plane[(MOST_WIDTH + GAP) * MOST_HEIGHT];
    const uint16_t *const lent[CONTEXT_VIEWS] = {plane, plane};
    const uint32_t stride = r->configuration->width + GAP;
    t3r_request request = {.gaussians = rebudgeted};
    if (r->configuration->allocate == T3R_ALLOCATE_GIVEN) {
        request.importance = lent;
        request.importance_stride_bytes = stride * 2;
    }
    for (uint32_t i = 0; i < stride * r->configuration->height; i++) {
        uint32_t x = i % stride, y = i / stride;
        plane[i] = (uint16_t)((x / 7 * 31 + y / 5 * 17) % 50 * 1000 + x * y % 40);
    }
    return rebudgeted != 0 ? t3r_rebuild(r->rt, &request, scene) : t3r_reconstruct(r->rt, &request, scene);
}

/* Draws the view between the context views and prints the hashes of the outputs. */
static t3r_status draw(run *r, const char *step)
{
    static uint8_t view[MOST_PIXELS * 3];
    static uint32_t depth_q20[MOST_PIXELS];
    static uint16_t alpha_q15[MOST_PIXELS];
    uint32_t width = r->configuration->width, height = r->configuration->height;
    t3r_camera camera;
    room_camera(TARGET_VIEW, width, height, &camera);
    t3r_target target = {.width = width,
                         .height = height,
                         .rgb = view,
                         .rgb_stride_bytes = width * 3,
                         .depth_q20 = depth_q20,
                         .depth_stride_bytes = width * 4,
                         .alpha_q15 = alpha_q15,
                         .alpha_stride_bytes = width * 2};
    t3r_status status = begin_step(r, step);
    if (status == T3R_OK) {
        status = t3r_render(r->rt, &camera, &target);
    }
    if (status == T3R_OK) {
        size_t pixels = (size_t)width * height;
        uint64_t hash = t3r_hash_u16s(t3r_hash_bytes(T3R_HASH_START, view, pixels * 3), alpha_q15, pixels);
        for (size_t i = 0; i < pixels; i++) {
            hash = t3r_hash_u32(hash, depth_q20[i]);
        }
        print_hash(r, "view", hash);
    }
    return status;
}

static int run_configuration(const configuration *c, variation ways)
{
    run r = {.configuration = c, .ways = ways};
    t3r_scene scene = {0};
    t3r_status status = begin_run(&r, false);
    for (uint32_t i = 0; status == T3R_OK && i < CONTEXT_VIEWS; i++) {
        status = add_view(&r, 2 * i);
    }
    if (status == T3R_OK && (status = begin_step(&r, "reconstruct")) == T3R_OK) {
        status = build(&r, 0, &scene);
    }
    if (status == T3R_OK) {
        printf("%s %s gaussians %" PRIu32 " of %" PRIu32 "\n", c->name, r.step, scene.count, scene.valid_points);
        status = draw(&r, "render");
    }
    if (status == T3R_OK && (status = begin_step(&r, "rebudget")) == T3R_OK) {
        status = build(&r, c->gaussians / 3, &scene);
    }
    if (status == T3R_OK) {
        printf("%s %s gaussians %" PRIu32 " of %" PRIu32 "\n", c->name, r.step, scene.count, scene.valid_points);
        status = draw(&r, "render_rebudgeted");
    }
    free(r.made);
    return status == T3R_OK ? 0 : failed(&r, status);
}

/* Streams with two live keyframes: hashes of the map after each step, and of a view of the final map. Passes of the
 * first compare all pixels, those of the second a part of them. */
#define STREAM(text, most)                                                                                             \
    {                                                                                                                  \
        .name = (text), .frame_width = 128, .frame_height = 96, .width = 91, .height = 77, .format = T3R_PIXEL_RGB24,  \
        .distortion = T3R_DISTORTION_NONE, .wavelet = T3R_WAVELET_DB2, .levels = 2, .clusters = 64,                    \
        .allocate = T3R_ALLOCATE_DENSITY, .head = T3R_HEAD_LEARNED, .gaussians = (most), .holes = true,                \
        .depth = T3R_DEPTH_SENSOR                                                                                      \
    }
static const configuration streams[] = {STREAM("stream", 700), STREAM("stream_part", 400)};

static int run_stream(const configuration *streamed, variation ways)
{
    static const char *const steps[] = {"keyframe_0", "keyframe_1", "keyframe_2", "keyframe_3"};
    run r = {.configuration = streamed, .ways = ways};
    t3r_status status = begin_run(&r, true);
    for (uint32_t i = 0; status == T3R_OK && i < sizeof steps / sizeof *steps; i++) {
        t3r_frame frame;
        t3r_camera camera;
        t3r_stream_report report;
        capture(streamed, i, &frame, &camera);
        status = begin_step(&r, steps[i]);
        if (status == T3R_OK) {
            status = t3r_stream_keyframe(r.rt, &frame, &camera, &report);
        }
        if (status == T3R_OK) {
            printf("%s %s gaussians %" PRIu32 " added %" PRIu32 " removed %" PRIu32 " crowded %" PRIu32
                   " shown %" PRIu32 " of %" PRIu32 "\n",
                   streamed->name, r.step, report.gaussians, report.added, report.removed, report.crowded, report.shown,
                   report.points);
        }
    }
    if (status == T3R_OK) {
        status = draw(&r, "render");
    }
    free(r.made);
    return status == T3R_OK ? 0 : failed(&r, status);
}

static int usage(void)
{
    fputs("golden_driver [--arena min|full|ten] [--tasks plain|reverse] [--workers N] [--moved]\n"
          "              [--cpu-mask MASK]\n",
          stderr);
    return 2;
}

int main(int argc, char **argv)
{
    variation ways = {ARENA_FULL, .workers = 1};
    for (int i = 1; i < argc; i++) {
        const char *value = i + 1 < argc ? argv[i + 1] : "";
        if (strcmp(argv[i], "--moved") == 0) {
            ways.moved = true;
        } else if (strcmp(argv[i], "--tasks") == 0 && (strcmp(value, "plain") == 0 || strcmp(value, "reverse") == 0)) {
            ways.reverse_tasks = strcmp(value, "reverse") == 0;
            i++;
        } else if (strcmp(argv[i], "--workers") == 0 && strlen(value) == 1 && value[0] >= '1' && value[0] <= '8') {
            ways.workers = (uint32_t)(value[0] - '0');
            i++;
        } else if (strcmp(argv[i], "--arena") == 0 && strcmp(value, "min") == 0) {
            ways.arena = ARENA_MIN;
            i++;
        } else if (strcmp(argv[i], "--arena") == 0 && strcmp(value, "full") == 0) {
            ways.arena = ARENA_FULL;
            i++;
        } else if (strcmp(argv[i], "--arena") == 0 && strcmp(value, "ten") == 0) {
            ways.arena = ARENA_TEN;
            i++;
        } else if (strcmp(argv[i], "--cpu-mask") == 0 && t3r_cpu_parse_mask(value, &ways.cpu)) {
            ways.cpu &= t3r_cpu_features();
            i++;
        } else {
            return usage();
        }
    }
    printf("bits epoch %d\n", T3R_BITS_EPOCH);
    for (size_t i = 0; i < sizeof configurations / sizeof *configurations; i++) {
        if (run_configuration(&configurations[i], ways) != 0) {
            return 1;
        }
    }
    for (size_t i = 0; i < sizeof streams / sizeof *streams; i++) {
        if (run_stream(&streams[i], ways) != 0) {
            return 1;
        }
    }
    return 0;
}
