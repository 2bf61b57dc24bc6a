/* Bytes to a sequence of calls of the C interface: wild settings, frames, cameras, Gaussians and targets, in any
 * order, in arenas of any size, with copies and cancellations in between. Whatever comes, every call answers with a
 * documented status, stays inside the memory it was given, and a copied arena draws the same picture. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "state/ablation.h"
#include "trim3r.h"
#include "weights_maker.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

enum { MOST_SIDE = 40, MOST_GAUSSIANS = 300, MOST_CALLS = 40, MOST_ARENA = 8 << 20 };

#define REQUIRE(condition)                                                                                             \
    do {                                                                                                               \
        if (!(condition)) {                                                                                            \
            fprintf(stderr, "line %d: not true: %s\n", __LINE__, #condition);                                          \
            abort();                                                                                                   \
        }                                                                                                              \
    } while (0)

/* ---- bytes to numbers ---------------------------------------------------------------------------- */

typedef struct input {
    const uint8_t *bytes;
    size_t left;
} input;

static uint8_t take8(input *in)
{
    if (in->left == 0) {
        return 0;
    }
    in->left--;
    return *in->bytes++;
}

static uint32_t take32(input *in)
{
    uint32_t x = 0;
    for (int i = 0; i < 4; i++) {
        x = x << 8 | take8(in);
    }
    return x;
}

static uint32_t below(input *in, uint32_t bound)
{
    uint32_t x = take8(in);
    return (bound > 256 ? x << 8 | take8(in) : x) % bound;
}

/* A size near the small ones, or one that must be refused. */
static uint32_t take_side(input *in)
{
    static const uint32_t wild[] = {0, 1, T3R_MAX_SIDE + 1, UINT32_MAX};
    uint32_t x = take8(in);
    return x < 252 ? 2 + x % (MOST_SIDE + 8) : wild[x - 252];
}

static void *allocate(size_t bytes)
{
    void *p = calloc(1, bytes == 0 ? 1 : bytes);
    REQUIRE(p != NULL);
    return p;
}

static void require_status(t3r_status status)
{
    REQUIRE((int)status <= T3R_OK && (int)status >= T3R_ERR_STEREO);
    REQUIRE(t3r_error_text(status)[0] != '\0');
}

/* ---- arguments ----------------------------------------------------------------------------------- */

static t3r_config take_config(input *in)
{
    t3r_config c = t3r_default_config(T3R_MIN_SIDE + below(in, MOST_SIDE), T3R_MIN_SIDE + below(in, MOST_SIDE),
                                      below(in, 4), 1 + below(in, MOST_GAUSSIANS));
    uint32_t flags = take8(in);
    c.gaussians = 1 + below(in, c.max_gaussians);
    c.render_width = 1 + below(in, MOST_SIDE);
    c.render_height = 1 + below(in, MOST_SIDE);
    c.clusters = 1 + below(in, 32);
    c.cluster_batches = below(in, 3);
    c.keep_analysis = flags & 1;
    c.allocation = (t3r_allocation)(1 + (flags >> 1) % (T3R_ALLOCATE_COUNT - 1));
    c.head = (t3r_head)(1 + (flags >> 3) % (T3R_HEAD_COUNT - 1));
    c.wavelet = (t3r_wavelet)((flags >> 5) % T3R_WAVELET_COUNT);
    c.wavelet_levels = 1 + below(in, T3R_MAX_LEVELS);
    c.refinements = below(in, 3);
    c.fill_radius = below(in, 9);
    c.bridge_radius = below(in, 33);
    c.colour_weight_q8 = below(in, 1025);
    c.gamma_q8 = below(in, 513);
    c.keep_percent = below(in, 101);
    c.seed = take8(in);
    c.flying = flags >> 7;
    c.redundancy = c.seed & 1;
    c.exposure = c.seed >> 1 & 1;
    c.depth = c.seed & 32 && c.width >= T3R_STEREO_LEAST_SIDE && c.height >= T3R_STEREO_LEAST_SIDE ? T3R_DEPTH_STEREO
                                                                                                   : T3R_DEPTH_SENSOR;
    c.stream = c.seed >> 6 == 3 && c.views > 0 && c.depth == T3R_DEPTH_SENSOR;
    c.head_column_bytes = c.seed & 4 ? below(in, 2048) : c.head_column_bytes;
    return c;
}

/* Any field to any value: planned and refused, never run (the bound on time is the settings' own). */
static void wild_config(input *in, t3r_config c)
{
    uint32_t field = below(in, sizeof c / sizeof(uint32_t)), value = take32(in);
    memcpy((uint8_t *)&c + field * sizeof value, &value, sizeof value);
    t3r_plan_info plan;
    t3r_status status = t3r_plan(&c, &plan);
    REQUIRE(status == (t3r_config_error(&c) == NULL ? T3R_OK : T3R_ERR_CONFIG));
    t3r_config most = c;
    const size_t bytes = take32(in);
    REQUIRE(t3r_plan_within(bytes, &most) != T3R_OK || (t3r_plan(&most, &plan) == T3R_OK && plan.min_bytes <= bytes));
    status = t3r_plan(&c, &plan);
    t3r_runtime *rt;
    uint8_t nothing[1];
    REQUIRE(t3r_init(&rt, nothing, 0, &c) != T3R_OK);
    REQUIRE(rt == NULL);
    REQUIRE(status != T3R_OK || (plan.min_bytes <= plan.bytes && plan.min_bytes >= T3R_HEADER_BYTES));
}

static t3r_camera take_camera(input *in)
{
    uint32_t kind = take8(in);
    t3r_camera c = {
        .fx_q16 = (int32_t)((8 + below(in, 120)) << 16),
        .fy_q16 = (int32_t)((8 + below(in, 120)) << 16),
        .cx_q16 = (int32_t)((below(in, MOST_SIDE)) << 16),
        .cy_q16 = (int32_t)((below(in, MOST_SIDE)) << 16),
        .rotation_q30 = {1 << 30, 0, 0, 0},
    };
    if (kind & 1) {
        for (int i = 0; i < 4; i++) {
            c.rotation_q30[i] = (int32_t)take32(in);
        }
    }
    if (kind & 2) {
        c.distortion = (t3r_distortion)below(in, T3R_DISTORTION_COUNT + 1);
        for (int i = 0; i < 5; i++) {
            c.distortion_q24[i] = (int32_t)take32(in);
        }
    }
    if (kind & 4) {
        for (int i = 0; i < 3; i++) {
            c.position_q32[i] = (int64_t)((uint64_t)take32(in) << 32 | take32(in)) >> (kind & 8 ? 32 : 0);
        }
    }
    if (kind & 16) {
        c.fx_q16 = (int32_t)take32(in);
        c.fy_q16 = (int32_t)take32(in);
        c.cx_q16 = (int32_t)take32(in);
        c.cy_q16 = (int32_t)take32(in);
    }
    return c;
}

/* Bytes that a plane of the format has at least, rows of `stride`. */
static uint64_t plane_bytes(const t3r_frame *f, int plane, uint32_t *row)
{
    uint64_t rows = plane == 0 ? f->height : f->height / 2;
    *row = f->width;
    if (f->format == T3R_PIXEL_RGB24 || f->format == T3R_PIXEL_BGR24) {
        *row = f->width * 3;
    } else if (f->format == T3R_PIXEL_YUYV || f->format == T3R_PIXEL_UYVY) {
        *row = f->width * 2;
    }
    return rows == 0 ? 0 : (rows - 1) * f->stride_bytes[plane] + *row;
}

static uint8_t *take_plane(input *in, size_t bytes)
{
    uint8_t *p = allocate(bytes);
    uint32_t base = take8(in), slope = take8(in), noise = take8(in), x = base + 1;
    for (size_t i = 0; i < bytes; i++) {
        x = x * 1664525u + 1013904223u;
        p[i] = (uint8_t)(base + slope * i / 16 + (noise == 0 ? 0 : (x >> 24) % noise));
    }
    for (uint32_t n = below(in, 8); n > 0 && bytes > 0; n--) {
        p[take32(in) % bytes] = take8(in);
    }
    return p;
}

typedef struct held_frame {
    t3r_frame frame;
    uint8_t *planes[3];
} held_frame;

/* Planes are allocated to the byte, so that a read beyond what width, height and stride promise is caught. */
static held_frame take_frame(input *in)
{
    held_frame held = {0};
    t3r_frame *f = &held.frame;
    uint32_t kind = take8(in);
    f->format = (t3r_pixel_format)(kind % (T3R_PIXEL_FORMAT_COUNT + 1));
    f->width = take_side(in);
    f->height = take_side(in);
    const int small = f->width > 0 && f->width <= 2 * MOST_SIDE && f->height <= 2 * MOST_SIDE;
    for (int plane = 0; plane < 2; plane++) {
        uint32_t row = 0;
        (void)plane_bytes(f, plane, &row);
        f->stride_bytes[plane] = row + below(in, 5);
        if (take8(in) == 255 && row > 0) {
            f->stride_bytes[plane] = row - 1; /* refused */
        }
        size_t bytes = small ? (size_t)plane_bytes(f, plane, &row) : 16;
        held.planes[plane] = plane == 0 || f->format == T3R_PIXEL_NV12 ? take_plane(in, bytes) : NULL;
        f->planes[plane] = held.planes[plane];
    }
    if (kind & 64) {
        f->depth_width = take_side(in);
        f->depth_height = take_side(in);
        f->depth_stride_bytes = f->depth_width * 2 + below(in, 5);
        const int fits = f->depth_width <= 2 * MOST_SIDE && f->depth_height <= 2 * MOST_SIDE && f->depth_height > 0;
        size_t bytes = fits ? (size_t)(f->depth_height - 1) * f->depth_stride_bytes + (size_t)f->depth_width * 2 : 16;
        held.planes[2] = take_plane(in, bytes);
        f->depth = held.planes[2];
        f->depth_unit_q40 = kind & 128 ? (uint64_t)take32(in) << (take8(in) % 33) : 1099511628;
    }
    return held;
}

static void free_frame(held_frame *held)
{
    for (int i = 0; i < 3; i++) {
        free(held->planes[i]);
    }
}

static t3r_gaussian take_gaussian(input *in)
{
    uint32_t kind = take8(in);
    t3r_gaussian g = {.opacity_q15 = (uint16_t)(take32(in) & 0x7fff), .confidence = 255};
    for (int i = 0; i < 3; i++) {
        g.position_q20[i] = kind & 1 ? (int32_t)take32(in) : (int32_t)(take8(in) << 13) - (i < 2 ? 1 << 20 : 0);
        g.colour_q7[i] = (uint16_t)(take8(in) * 128);
    }
    g.factor_exponent = kind & 2 ? (int8_t)take8(in) : (int8_t)(-(int)below(in, 30));
    for (int i = 0; i < 9; i++) {
        g.factor[i] = (int16_t)(kind & 4 ? take32(in) : take8(in));
    }
    if (kind & 8) {
        g.opacity_q15 = (uint16_t)take32(in);
        g.colour_q7[kind % 3] = (uint16_t)take32(in);
        g.reserved[kind % 3] = take8(in);
        g.view = take8(in);
    }
    return g;
}

/* ---- calls --------------------------------------------------------------------------------------- */

typedef struct session {
    t3r_config config;
    uint8_t *arena;
    size_t arena_bytes;
    t3r_runtime *rt;
    uint32_t calls_until_cancelled;
} session;

static uint8_t *allocate_arena(size_t bytes)
{
    void *p = NULL;
    REQUIRE(posix_memalign(&p, T3R_ARENA_ALIGN, bytes == 0 ? 1 : bytes) == 0);
    memset(p, 0xc3, bytes);
    return p;
}

static int progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    session *s = user;
    REQUIRE((int)stage >= 0 && stage < T3R_STAGE_COUNT && done <= total);
    return s->calls_until_cancelled > 0 && --s->calls_until_cancelled == 0;
}

static void check_scene(const session *s, t3r_status status, const t3r_scene *scene, uint32_t budget)
{
    require_status(status);
    if (status != T3R_OK) {
        return;
    }
    REQUIRE(scene->count <= budget && scene->count <= s->config.max_gaussians);
    for (uint32_t i = 0; i < scene->count; i++) {
        const t3r_gaussian *g = &scene->gaussians[i];
        REQUIRE(g->factor_exponent >= -60 && g->factor_exponent <= 15 && g->opacity_q15 <= 32767);
        REQUIRE(g->colour_q7[0] <= 32640 && g->colour_q7[1] <= 32640 && g->colour_q7[2] <= 32640);
        REQUIRE(g->reserved[0] == 0 && g->reserved[1] == 0 && g->reserved[2] == 0);
    }
}

typedef struct picture {
    t3r_target target;
    size_t bytes[3];
} picture;

static picture picture_of(uint32_t width, uint32_t height, uint32_t padding)
{
    picture p = {.target = {.width = width,
                            .height = height,
                            .rgb_stride_bytes = width * 3 + padding,
                            .depth_stride_bytes = width * 4 + padding * 4,
                            .alpha_stride_bytes = width * 2 + padding * 2}};
    if (width <= 2 * MOST_SIDE && height <= 2 * MOST_SIDE && height > 0) {
        p.bytes[0] = (size_t)(height - 1) * p.target.rgb_stride_bytes + (size_t)width * 3;
        p.bytes[1] = (size_t)(height - 1) * p.target.depth_stride_bytes + (size_t)width * 4;
        p.bytes[2] = (size_t)(height - 1) * p.target.alpha_stride_bytes + (size_t)width * 2;
    }
    p.target.rgb = allocate(p.bytes[0]);
    p.target.depth_q20 = allocate(p.bytes[1]);
    p.target.alpha_q15 = allocate(p.bytes[2]);
    return p;
}

static void free_picture(picture *p)
{
    free(p->target.rgb);
    free(p->target.depth_q20);
    free(p->target.alpha_q15);
}

static void call_render(session *s, input *in)
{
    t3r_camera camera = take_camera(in);
    uint32_t width = take_side(in), height = take_side(in), padding = below(in, 4);
    picture first = picture_of(width, height, padding), second = picture_of(width, height, padding);
    t3r_status status = t3r_render(s->rt, &camera, &first.target);
    require_status(status);
    if (status == T3R_OK) {
        REQUIRE(width <= s->config.render_width && height <= s->config.render_height);
        REQUIRE(t3r_render_passes(s->rt) >= 1);
        /* the same from a copy, elsewhere; hooks are left behind */
        uint8_t *copy = allocate_arena(s->arena_bytes);
        memcpy(copy, s->arena, s->arena_bytes);
        t3r_runtime *rt;
        REQUIRE(t3r_attach(&rt, copy, s->arena_bytes) == T3R_OK);
        REQUIRE(t3r_render(rt, &camera, &second.target) == T3R_OK);
        REQUIRE(memcmp(first.target.rgb, second.target.rgb, first.bytes[0]) == 0);
        REQUIRE(memcmp(first.target.depth_q20, second.target.depth_q20, first.bytes[1]) == 0);
        REQUIRE(memcmp(first.target.alpha_q15, second.target.alpha_q15, first.bytes[2]) == 0);
        free(copy);
    }
    free_picture(&first);
    free_picture(&second);
}

static void call_develop(session *s, input *in)
{
    t3r_camera camera = take_camera(in), undistorted;
    held_frame held = take_frame(in);
    size_t pixels = (size_t)s->config.width * s->config.height;
    uint8_t *rgb = allocate(pixels * 3);
    uint16_t *depth = allocate(pixels * 2);
    require_status(t3r_develop(s->rt, &held.frame, &camera, rgb, depth, &undistorted));
    free(rgb);
    free(depth);
    free_frame(&held);
}

static void call_add_view(session *s, input *in)
{
    t3r_camera camera = take_camera(in);
    held_frame held = take_frame(in);
    require_status(t3r_add_view(s->rt, &held.frame, &camera));
    free_frame(&held);
}

/* A keyframe or a few, in an arena for streams or in one that refuses them. */
static void call_stream(session *s, input *in)
{
    for (uint32_t n = 1 + below(in, 3); n > 0; n--) {
        t3r_camera camera = take_camera(in);
        held_frame held = take_frame(in);
        t3r_stream_report report;
        t3r_status status = t3r_stream_keyframe(s->rt, &held.frame, &camera, take8(in) & 1 ? &report : NULL);
        require_status(status);
        uint32_t overlap_q8 = 0;
        require_status(t3r_stream_overlap(s->rt, &camera, held.frame.width, held.frame.height, &overlap_q8));
        REQUIRE(overlap_q8 <= 256);
        REQUIRE(s->config.stream || status != T3R_OK);
        t3r_scene scene;
        if (t3r_get_scene(s->rt, &scene) == T3R_OK && s->config.stream) {
            REQUIRE(scene.count <= s->config.gaussians);
        }
        free_frame(&held);
    }
}

static void call_scene(session *s, input *in)
{
    t3r_scene_frame frame = {{0}, 0};
    if (take8(in) & 1) {
        for (int i = 0; i < 3; i++) {
            frame.origin_q32[i] = (int64_t)((uint64_t)take32(in) << 32 | take32(in));
        }
        frame.exponent = (int32_t)take32(in);
    }
    require_status(t3r_scene_begin(s->rt, &frame));
}

/* Moves the arena to a new place and forgets the old one. */
static void call_move(session *s)
{
    uint8_t *moved = allocate_arena(s->arena_bytes);
    memcpy(moved, s->arena, s->arena_bytes);
    memset(s->arena, 0xee, s->arena_bytes);
    free(s->arena);
    s->arena = moved;
    REQUIRE(t3r_attach(&s->rt, s->arena, s->arena_bytes) == T3R_OK);
    t3r_runtime *rt;
    REQUIRE(t3r_attach(&rt, s->arena, s->arena_bytes / 2) != T3R_OK && rt == NULL);
}

/* Planes of exactly the bytes that may be read, for the views that there may be; some missing, some strides wrong.
 * False when they are to be refused whatever views there are. */
static bool take_importance(const session *s, input *in, uint16_t *planes[T3R_MAX_VIEWS], t3r_request *request)
{
    const uint32_t width = s->config.width, height = s->config.height, kind = below(in, 16);
    const uint32_t stride = kind == 1 ? 2 * width - 1 : kind == 2 ? 2 * width + 1 : 2 * (width + below(in, 3));
    for (uint32_t v = 0; v < s->config.views; v++) {
        uint32_t seed = take8(in);
        const size_t bytes = (size_t)stride * (height - 1) + 2 * (size_t)width;
        planes[v] = kind == 3 && v == 1 ? NULL : allocate(bytes);
        for (size_t i = 0; i < bytes / 2 && planes[v] != NULL; i++) {
            planes[v][i] = (uint16_t)(i * (seed | 1) * 641 >> (seed & 7));
        }
    }
    request->importance = (const uint16_t *const *)planes;
    request->importance_stride_bytes = stride;
    return kind != 1 && kind != 2;
}

enum { BUDGET = 1, LOSS = 2, ALLOCATION = 4, HEAD = 8, IMPORTANCE = 16 }; /* what a request asks for */

/* First or again, by a request of any parts. */
static void call_build(session *s, input *in, uint32_t parts)
{
    uint16_t *planes[T3R_MAX_VIEWS] = {NULL};
    t3r_request request = {.gaussians = parts & BUDGET ? below(in, MOST_GAUSSIANS + 20) : 0,
                           .max_loss_q8 = parts & LOSS ? below(in, T3R_MAX_LOSS_Q8 + 10) : 0,
                           .allocation = (t3r_allocation)(parts & ALLOCATION ? below(in, T3R_ALLOCATE_COUNT + 1) : 0),
                           .head = (t3r_head)(parts & HEAD ? below(in, T3R_HEAD_COUNT + 1) : 0)};
    const bool sound = !(parts & IMPORTANCE) || take_importance(s, in, planes, &request);
    t3r_scene scene;
    t3r_status status = take8(in) & 1 ? t3r_rebuild(s->rt, &request, &scene) : t3r_reconstruct(s->rt, &request, &scene);
    check_scene(s, status, &scene, request.gaussians != 0 ? request.gaussians : s->config.gaussians);
    REQUIRE(status != T3R_OK || sound);
    for (uint32_t v = 0; v < s->config.views; v++) {
        free(planes[v]);
    }
}

/* The whole way at once, so that short inputs come deep. */
static void call_all(session *s, input *in)
{
    for (uint32_t v = 1 + below(in, s->config.views + 1); v > 0; v--) {
        call_add_view(s, in);
    }
    t3r_scene scene;
    check_scene(s, t3r_reconstruct(s->rt, NULL, &scene), &scene, s->config.gaussians);
    call_render(s, in);
}

/* A head, one cut short, or none. */
static void call_bind(session *s, input *in)
{
    static uint8_t *weights;
    static size_t bytes;
    if (weights == NULL) {
        weights = make_weights(small_shape, small_layers, 8, 8, 1, &bytes);
    }
    uint32_t kind = below(in, 6);
    t3r_status status = t3r_bind_head(s->rt, kind == 0 ? NULL : weights, kind == 1 ? bytes - 1 : bytes);
    require_status(status);
    REQUIRE(kind != 1 || status != T3R_OK);
    REQUIRE(kind != 0 || status == T3R_OK);
}

static void call(session *s, input *in)
{
    t3r_scene scene;
    switch (s->config.stream && (take8(in) & 3) != 0 ? 18 : take8(in) % 19) {
    case 18:
        call_stream(s, in);
        break;
    case 17:
        call_build(s, in, LOSS | (take8(in) & (BUDGET | IMPORTANCE)));
        break;
    case 16:
        call_build(s, in, IMPORTANCE);
        break;
    case 15:
        call_build(s, in, take8(in));
        break;
    case 14:
        call_bind(s, in);
        break;
    case 0:
    case 1:
        call_add_view(s, in);
        break;
    case 2:
        check_scene(s, t3r_reconstruct(s->rt, NULL, &scene), &scene, s->config.gaussians);
        break;
    case 3:
        call_build(s, in, BUDGET);
        break;
    case 4:
        call_build(s, in, BUDGET | ALLOCATION | HEAD);
        break;
    case 5:
        call_scene(s, in);
        break;
    case 6:
        for (uint32_t n = 1 + below(in, 16); n > 0; n--) {
            t3r_gaussian g = take_gaussian(in);
            require_status(t3r_scene_append(s->rt, &g));
        }
        break;
    case 7:
    case 8:
        call_render(s, in);
        break;
    case 9:
        call_develop(s, in);
        break;
    case 10:
        call_move(s);
        break;
    case 11:
    case 12:
        call_all(s, in);
        break;
    default:
        if (take8(in) & 1) {
            t3r_hooks hooks = {.user = s, .progress = progress};
            s->calls_until_cancelled = take8(in);
            require_status(t3r_set_hooks(s->rt, &hooks));
        } else {
            require_status(t3r_reset(s->rt));
        }
        break;
    }
    check_scene(s, t3r_get_scene(s->rt, &scene), &scene, UINT32_MAX);
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    input in = {bytes, count};
    session s = {.config = take_config(&in)};
    wild_config(&in, s.config);
    t3r_plan_info plan;
    REQUIRE(t3r_plan(&s.config, &plan) == T3R_OK);
    if (plan.bytes > MOST_ARENA) {
        return 0;
    }
    const size_t sizes[] = {plan.min_bytes, plan.bytes, (plan.min_bytes + plan.bytes) / 2, plan.min_bytes - 1,
                            take32(&in) % (plan.bytes + 1)};
    s.arena_bytes = sizes[take8(&in) % 5];
    s.arena = allocate_arena(s.arena_bytes);
    t3r_status status = t3r_init(&s.rt, s.arena, s.arena_bytes, &s.config);
    REQUIRE(status == (s.arena_bytes < plan.min_bytes ? T3R_ERR_ARENA : T3R_OK));
    REQUIRE((s.rt != NULL) == (status == T3R_OK));
    if (status == T3R_OK) {
        const t3r_ablation ablation = {.shuffle = s.config.seed >> 4 & 1, .unadapted = ~s.config.seed >> 3 & 1};
        REQUIRE(t3r_set_ablation(s.rt, &ablation) == T3R_OK);
    }
    if (status == T3R_OK && s.config.head == T3R_HEAD_LEARNED) {
        call_bind(&s, &in);
    }
    for (uint32_t i = 0; status == T3R_OK && i < MOST_CALLS && in.left > 0; i++) {
        call(&s, &in);
    }
    free(s.arena);
    return 0;
}
