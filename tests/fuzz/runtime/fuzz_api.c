/* SPDX-License-Identifier: Apache-2.0 */
/* Turns bytes into calls of the C interface: wild settings, frames, cameras, Gaussians and targets, in any order, in
 * arenas of any size, with copies and cancellations in between. Every call returns a documented status and stays
 * inside its memory, and a copied arena draws the same picture. */
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "arguments.h"
#include "state/ablation.h"
#include "trim3r.h"
#include "weights_maker.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

enum { MOST_GAUSSIANS = 300, MOST_CALLS = 40, MOST_ARENA = 8 << 20 };

/* Requires a documented status, and that an error has a sentence of its own: the checks that find it agree with those
 * of the call. */
static void require_reason(t3r_status status, const char *sentence)
{
    require_status(status);
    REQUIRE(sentence[0] != '\0' &&
            (status == T3R_OK || status == T3R_ERR_CANCELLED || strcmp(sentence, t3r_error_text(status)) != 0));
}

/* Makes a call, which may be refused, and asks for the reason. */
#define CALL(status, function, ...)                                                                                    \
    do {                                                                                                               \
        char text[T3R_ERROR_BYTES];                                                                                    \
        (status) = function(__VA_ARGS__);                                                                              \
        require_reason((status), function##_error((status), __VA_ARGS__, text, sizeof text));                          \
    } while (0)

/* ---- arguments ----------------------------------------------------------------------------------- */

static t3r_config take_config(input *in)
{
    t3r_config c = t3r_default_config(T3R_MIN_SIDE + below(in, MOST_SIDE), T3R_MIN_SIDE + below(in, MOST_SIDE),
                                      below(in, 4), 1 + below(in, MOST_GAUSSIANS));
    c.gaussians = 1 + below(in, c.max_gaussians);
    c.render_width = 1 + below(in, MOST_SIDE);
    c.render_height = 1 + below(in, MOST_SIDE);
    const bool by_sensor = c.width < T3R_STEREO_LEAST_SIDE || c.height < T3R_STEREO_LEAST_SIDE || take8(in) < 192;
    t3r_config most = most_settings();
    most.clusters = 32;
    most.cluster_batches = 2;
    most.head_column_bytes = 2048;
    most.refine = 2;
    most.depth = by_sensor ? T3R_DEPTH_SENSOR : T3R_DEPTH_STEREO;
    most.bridge_radius = 32;
    most.warm = most.stream = 0;
    most.workers = 1;
    most.tile_splats = 512;
    take_settings(in, SETTING_AT(wavelet), &most, &c);
    c.stream = c.views > 0 && c.depth == T3R_DEPTH_SENSOR && take8(in) < 64;
    return c;
}

/* Sets any field to any value: planned and refused, never run, because only the settings' own bounds limit the time. */
static void wild_config(input *in, t3r_config c)
{
    uint32_t field = below(in, sizeof c / sizeof(uint32_t)), value = take32(in);
    memcpy((uint8_t *)&c + field * sizeof value, &value, sizeof value);
    t3r_plan_info plan;
    t3r_status status;
    CALL(status, t3r_plan, &c, &plan);
    REQUIRE(status == (t3r_config_error(&c) == NULL ? T3R_OK : T3R_ERR_CONFIG));
    t3r_config most = c;
    const size_t bytes = take32(in);
    t3r_status within;
    CALL(within, t3r_plan_within, bytes, &most);
    REQUIRE(within != T3R_OK || (t3r_plan(&most, &plan) == T3R_OK && plan.min_bytes <= bytes));
    status = t3r_plan(&c, &plan);
    t3r_status opened;
    t3r_runtime *rt;
    uint8_t nothing[1];
    CALL(opened, t3r_init, &rt, nothing, 0, &c);
    REQUIRE(opened != T3R_OK && rt == NULL);
    REQUIRE(status != T3R_OK || (plan.min_bytes <= plan.bytes && plan.min_bytes >= T3R_HEADER_BYTES));
}

/* ---- calls --------------------------------------------------------------------------------------- */

typedef struct session {
    t3r_config config;
    uint8_t *arena;
    size_t arena_bytes;
    t3r_runtime *rt;
    uint32_t calls_until_cancelled;
} session;

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

static void call_render(session *s, input *in)
{
    t3r_camera camera = take_camera(in);
    uint32_t width = take_side(in), height = take_side(in), padding = below(in, 4);
    picture first = picture_of(width, height, padding), second = picture_of(width, height, padding);
    t3r_status status;
    CALL(status, t3r_render, s->rt, &camera, &first.target);
    if (status == T3R_OK) {
        REQUIRE(width <= s->config.render_width && height <= s->config.render_height);
        REQUIRE(t3r_render_passes(s->rt) >= 1);
        /* the same from a copy elsewhere, without hooks */
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
    t3r_status status;
    CALL(status, t3r_develop, s->rt, &held.frame, &camera, rgb, depth, &undistorted);
    free(rgb);
    free(depth);
    free_frame(&held);
}

static void call_add_view(session *s, input *in)
{
    t3r_camera camera = take_camera(in);
    held_frame held = take_frame(in);
    t3r_status status;
    CALL(status, t3r_add_view, s->rt, &held.frame, &camera);
    free_frame(&held);
}

/* Adds a frame in strips, some out of order; planes begin at the strip. */
static void call_add_rows(session *s, input *in)
{
    t3r_camera camera = take_camera(in);
    held_frame held = take_frame(in);
    const uint32_t step = 1 + below(in, 16);
    uint32_t row = 0;
    for (t3r_status status = T3R_OK; status == T3R_OK && row <= T3R_MAX_SIDE; row += step) {
        const uint32_t wrong = take8(in) == 7 ? below(in, 4) : 0;
        t3r_frame part = held.frame;
        const uint32_t depth_row = row < part.depth_height ? row : part.depth_height;
        const uint32_t rows = row + step < part.height ? step : row < part.height ? part.height - row : 0;
        const uint32_t depth_rows = depth_row + step < part.depth_height ? step : part.depth_height - depth_row;
        if (rows == 0 && depth_rows == 0) {
            break;
        }
        for (int plane = 0; plane < 2; plane++) {
            if (part.planes[plane] != NULL && row < part.height) {
                part.planes[plane] += (size_t)(row >> plane) * part.stride_bytes[plane];
            }
        }
        if (part.depth != NULL) {
            part.depth += (size_t)(depth_rows == 0 ? 0 : depth_row) * part.depth_stride_bytes;
        }
        CALL(status, t3r_add_rows, s->rt, &part, &camera, row < part.height ? row : part.height, rows,
             depth_row + wrong, depth_rows);
        REQUIRE(wrong == 0 || status != T3R_OK || s->config.depth == T3R_DEPTH_STEREO);
    }
    free_frame(&held);
}

/* Adds one or more keyframes, in an arena for streams or in one that refuses them. */
static void call_stream(session *s, input *in)
{
    for (uint32_t n = 1 + below(in, 3); n > 0; n--) {
        t3r_camera camera = take_camera(in);
        held_frame held = take_frame(in);
        t3r_stream_report report;
        t3r_stream_report *const wanted = take8(in) & 1 ? &report : NULL;
        t3r_status status, compared;
        CALL(status, t3r_stream_keyframe, s->rt, &held.frame, &camera, wanted);
        uint32_t overlap_q8 = 0;
        CALL(compared, t3r_stream_overlap, s->rt, &camera, held.frame.width, held.frame.height, &overlap_q8);
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
    t3r_status status;
    CALL(status, t3r_scene_begin, s->rt, &frame);
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
    t3r_status status;
    CALL(status, t3r_attach, &rt, s->arena, s->arena_bytes / 2);
    REQUIRE(status != T3R_OK && rt == NULL);
}

/* Makes planes of exactly the bytes that may be read, for at most all views; some are missing, some strides wrong.
 * Returns false if they must be refused for any number of views. */
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

enum { BUDGET = 1, LOSS = 2, ALLOCATION = 4, HEAD = 8, IMPORTANCE = 16 }; /* parts of a request */

/* Builds or rebuilds with a request of any parts. */
static void call_build(session *s, input *in, uint32_t parts)
{
    uint16_t *planes[T3R_MAX_VIEWS] = {NULL};
    t3r_request request = {.gaussians = parts & BUDGET ? below(in, MOST_GAUSSIANS + 20) : 0,
                           .max_loss_q8 = parts & LOSS ? below(in, T3R_MAX_LOSS_Q8 + 10) : 0,
                           .allocate = (t3r_allocation)(parts & ALLOCATION ? below(in, T3R_ALLOCATE_COUNT + 1) : 0),
                           .head = (t3r_head)(parts & HEAD ? below(in, T3R_HEAD_COUNT + 1) : 0)};
    const bool sound = !(parts & IMPORTANCE) || take_importance(s, in, planes, &request);
    t3r_scene scene;
    t3r_status status;
    if (take8(in) & 1) {
        CALL(status, t3r_rebuild, s->rt, &request, &scene);
    } else {
        CALL(status, t3r_reconstruct, s->rt, &request, &scene);
    }
    check_scene(s, status, &scene, request.gaussians != 0 ? request.gaussians : s->config.gaussians);
    REQUIRE(status != T3R_OK || sound);
    for (uint32_t v = 0; v < s->config.views; v++) {
        free(planes[v]);
    }
}

/* Runs a whole session, so that short inputs reach far. */
static void call_all(session *s, input *in)
{
    for (uint32_t v = 1 + below(in, s->config.views + 1); v > 0; v--) {
        call_add_view(s, in);
    }
    t3r_scene scene;
    check_scene(s, t3r_reconstruct(s->rt, NULL, &scene), &scene, s->config.gaussians);
    call_render(s, in);
}

/* Binds a head, a truncated head, or none. */
static void call_bind(session *s, input *in)
{
    static uint8_t *weights;
    static size_t bytes;
    if (weights == NULL) {
        weights = make_weights(small_shape, small_layers, 8, 8, 1, &bytes);
    }
    uint32_t kind = below(in, 6);
    t3r_status status;
    CALL(status, t3r_bind_head, s->rt, kind == 0 ? NULL : weights, kind == 1 ? bytes - 1 : bytes);
    REQUIRE(kind != 1 || status != T3R_OK);
    REQUIRE(kind != 0 || status == T3R_OK);
}

static void call(session *s, input *in)
{
    t3r_scene scene;
    switch (s->config.stream && (take8(in) & 3) != 0 ? 18 : take8(in) % 20) {
    case 19:
        call_add_rows(s, in);
        break;
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
            t3r_status status;
            CALL(status, t3r_scene_append, s->rt, &g);
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
