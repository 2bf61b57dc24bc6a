/* SPDX-License-Identifier: Apache-2.0 */
/* Turns bytes into damages of a stored arena, and into calls once it is attached. Checks of single fields do not
 * find these damages: labels, counts, depths, order and the state's numbers change together and still agree, or
 * agree except one. t3r_attach() may refuse such an arena. An accepted arena must be safe in every call: documented
 * statuses, no access beyond the arena, layout and configuration unchanged, scenes within their budget and with
 * every field in range. */
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <string.h>

#include "api/checks.h"
#include "arguments.h"
#include "budget/budget.h"
#include "budget/cluster_texture.h"
#include "core/fixed.h"
#include "core/map_record.h"
#include "rgbd_frame.h"
#include "scene/formats/ply/ply.h"
#include "state/state.h"
#include "state/views.h"
#include "superclusters/superclusters.h"
#include "weights_maker.h"

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count);

enum { WIDTH = 40, HEIGHT = 32, BUDGET = 100, FEW = 5, MANY = 300, MOST_DAMAGES = 12, MOST_CALLS = 4, FAR_MM = 1500 };

/* ---- valid arenas -------------------------------------------------------------------------------- */

/* ANALYSED_MANY has labels of nine bits. */
typedef enum base { ANALYSED, BY_STEREO, STREAM, SCENE_ONLY, VIEWS_ONLY, BUILT, ANALYSED_MANY, BASES } base;

typedef struct stored {
    uint8_t *arena;
    size_t bytes;
} stored;

static t3r_config config_of(base which)
{
    t3r_config c = t3r_default_config(WIDTH, HEIGHT, which == SCENE_ONLY ? 0 : 3, 2 * BUDGET);
    c.gaussians = BUDGET;
    c.clusters = which == ANALYSED_MANY ? MANY : which == VIEWS_ONLY ? 0 : FEW; /* 0: t3r_init() chooses */
    c.cluster_batches = 2;
    c.refine = 1;
    c.workers = 3;
    c.keep_analysis = which == ANALYSED || which == BY_STEREO || which == ANALYSED_MANY;
    c.depth = which == BY_STEREO ? T3R_DEPTH_STEREO : T3R_DEPTH_SENSOR;
    c.stream = which == STREAM;
    return c;
}

static t3r_camera camera_at(uint32_t place)
{
    return (t3r_camera){.fx_q16 = 40 << 16,
                        .fy_q16 = 40 << 16,
                        .cx_q16 = (WIDTH / 2) << 16,
                        .cy_q16 = (HEIGHT / 2) << 16,
                        .position_q32 = {(int64_t)place << 29},
                        .rotation_q30 = {1 << 30}};
}

/* Draws a wall of noise as the camera at that place sees it, with a step in it and a few holes. */
static void draw_frame(uint32_t place, uint8_t colour[HEIGHT][WIDTH][3], uint16_t depth[HEIGHT][WIDTH])
{
    for (uint32_t y = 0; y < HEIGHT; y++) {
        for (uint32_t x = 0; x < WIDTH; x++) {
            const uint32_t along = x + place * 40 * 1000 / (8 * FAR_MM), noise = t3r_mix32(along / 2 << 8 | y / 2);
            for (int c = 0; c < 3; c++) {
                colour[y][x][c] = (uint8_t)(noise >> (8 * c));
            }
            depth[y][x] = (x * y) % 37 == 5 ? 0 : (uint16_t)(y < HEIGHT / 4 ? 2 * FAR_MM : FAR_MM);
        }
    }
}

static t3r_status show(t3r_runtime *rt, uint32_t place)
{
    static uint8_t colour[HEIGHT][WIDTH][3];
    static uint16_t depth[HEIGHT][WIDTH];
    draw_frame(place, colour, depth);
    const t3r_frame frame = rgbd_frame(&colour[0][0][0], (const uint8_t *)depth, WIDTH, HEIGHT, MILLIMETRE_Q40);
    const t3r_camera camera = camera_at(place);
    return rt->config.stream ? t3r_stream_keyframe(rt, &frame, &camera, NULL) : t3r_add_view(rt, &frame, &camera);
}

static stored make(base which)
{
    const t3r_config config = config_of(which);
    t3r_plan_info plan;
    REQUIRE(t3r_plan(&config, &plan) == T3R_OK);
    stored made = {allocate_arena(plan.bytes), plan.bytes};
    t3r_runtime *rt;
    REQUIRE(t3r_init(&rt, made.arena, made.bytes, &config) == T3R_OK);
    for (uint32_t place = 0; which != SCENE_ONLY && place < (which == STREAM ? 5u : 2u); place++) {
        REQUIRE(show(rt, place) == T3R_OK);
    }
    t3r_scene scene;
    if (which == ANALYSED || which == BY_STEREO || which == BUILT || which == ANALYSED_MANY) {
        REQUIRE(t3r_reconstruct(rt, NULL, &scene) == T3R_OK);
    }
    if (which == SCENE_ONLY) {
        const t3r_scene_frame frame = {{0}, 0};
        REQUIRE(t3r_scene_begin(rt, &frame) == T3R_OK);
    }
    return made;
}

/* ---- damages ------------------------------------------------------------------------------------- */

/* Returns a number at the limits of its range, or any. */
static uint32_t take_number(input *in, uint32_t bound)
{
    const uint32_t known[] = {0, 1, bound - 1, bound, bound + 1, UINT32_MAX, bound / 2};
    const uint32_t kind = below(in, 9);
    return kind < 7 ? known[kind] : kind == 7 ? below(in, bound + 1) : take32(in);
}

static size_t points_of(const t3r_runtime *rt)
{
    return (size_t)WIDTH * HEIGHT * T3R_MIN(rt->config.views, 3u);
}

static bool has_labels(const t3r_runtime *rt)
{
    return rt->config.views > 0 && !rt->config.stream && rt->config.clusters > 0;
}

static void damage_bytes(t3r_runtime *rt, input *in, bool of_the_state)
{
    const size_t range = of_the_state ? sizeof *rt : (size_t)rt->arena_bytes, at = take32(in) % range;
    const size_t drawn =
        (size_t)1 << below(in, of_the_state ? 4 : 12); /* drawn once: the macro evaluates its arguments twice */
    const size_t bytes = T3R_MIN(drawn, range - at);
    const uint32_t pattern = take8(in), seed = take32(in);
    for (size_t i = 0; i < bytes; i++) {
        ((uint8_t *)rt)[at + i] = (uint8_t)(pattern & 1 ? seed : t3r_mix32(seed + (uint32_t)i));
    }
}

static void damage_state(t3r_runtime *rt, input *in)
{
    const uint32_t most = rt->config.max_gaussians, view = below(in, T3R_MAX_VIEWS);
    switch (below(in, 18)) {
    case 0:
        rt->views = take_number(in, rt->config.views);
        break;
    case 1:
        rt->gaussians = take_number(in, most);
        break;
    case 2:
        rt->valid_points = take_number(in, WIDTH * HEIGHT * 3);
        break;
    case 3:
        rt->keyframes = take_number(in, rt->views);
        break;
    case 4:
        rt->next_slot = take_number(in, rt->config.views);
        break;
    case 5:
        rt->has_scene = take_number(in, 2);
        break;
    case 6:
        rt->analysed = take_number(in, 2);
        break;
    case 7:
        rt->build.gaussians = take_number(in, most);
        break;
    case 8:
        rt->build.allocate = (t3r_allocation)take_number(in, T3R_ALLOCATE_COUNT);
        break;
    case 9:
        rt->build.head = (t3r_head)take_number(in, T3R_HEAD_COUNT);
        break;
    case 10:
        rt->camera[view] = take_camera(in);
        break;
    case 11:
        rt->depth_unit_q40[view] = (uint64_t)take32(in) << below(in, 34);
        break;
    case 12:
        rt->frame.exponent = (int32_t)take_number(in, 50) - 25;
        break;
    case 13:
        rt->frame.origin_q32[view % 3] = (int64_t)((uint64_t)take32(in) << below(in, 33));
        break;
    case 14:
        rt->median_depth_q20 = (int32_t)take_number(in, 2 << 20);
        break;
    case 15:
        rt->gain_q14[view][view % 3] = (uint16_t)take32(in);
        break;
    case 16:
        rt->stereo_partner[view] = take8(in);
        break;
    default:
        rt->stereo_pair[view] = take8(in);
        break;
    }
}

/* Damages a setting on which no byte of the layout depends. */
static void damage_config(t3r_runtime *rt, input *in)
{
    static const uint8_t laid_out[] = {SETTING_AT(clusters),      SETTING_AT(head_column_bytes),
                                       SETTING_AT(refine),        SETTING_AT(depth),
                                       SETTING_AT(keep_analysis), SETTING_AT(warm),
                                       SETTING_AT(stream),        SETTING_AT(workers)};
    t3r_config most = most_settings();
    most.gaussians = rt->config.max_gaussians;
    most.tile_splats = BUDGET;
    const size_t drawn = SETTING_AT(wavelet) + below(in, sizeof most / sizeof(uint32_t) - SETTING_AT(wavelet));
    const size_t at = memchr(laid_out, (int)drawn, sizeof laid_out) == NULL ? drawn : SETTING_AT(gaussians);
    uint32_t high;
    memcpy(&high, (const uint8_t *)&most + at * sizeof high, sizeof high);
    const uint32_t value = take_number(in, high);
    memcpy((uint8_t *)&rt->config + at * sizeof value, &value, sizeof value);
}

static void damage_depth(t3r_runtime *rt, input *in)
{
    uint8_t *validity = t3r_buffer_at(rt, T3R_BUFFER_VALIDITY);
    uint16_t *depth = t3r_buffer_at(rt, T3R_BUFFER_DEPTH);
    const uint32_t kind = take8(in), seed = take32(in), every = 1 + take8(in);
    for (size_t i = 0; i < points_of(rt); i += every) {
        const uint32_t noise = t3r_mix32(seed + (uint32_t)i);
        validity[i] = (uint8_t)(kind & 1 ? noise : kind & 2 ? kind >> 4 : validity[i]);
        depth[i] = (uint16_t)(kind & 4 ? noise >> 16 : kind & 8 ? seed : depth[i]);
    }
}

/* Returns all views as one, because their planes are stored one after the other. */
static t3r_view all_views(const t3r_runtime *rt)
{
    return (t3r_view){.validity = t3r_buffer_at(rt, T3R_BUFFER_VALIDITY),
                      .label = t3r_buffer_at(rt, T3R_BUFFER_LABELS)};
}

static void change_label(const t3r_view *all, size_t pixel, uint32_t label)
{
    all->validity[pixel] &= (uint8_t)~T3R_LABEL_HIGH;
    t3r_set_label(all, pixel, label);
}

static void damage_labels(t3r_runtime *rt, input *in)
{
    const t3r_view all = all_views(rt);
    uint16_t *texture = t3r_buffer_at(rt, T3R_BUFFER_TEXTURE);
    const uint32_t clusters = rt->config.clusters;
    const uint32_t kind = take8(in), seed = take32(in), every = 1 + take8(in) % 4;
    for (size_t i = 0; has_labels(rt) && i < points_of(rt); i += every) {
        const uint32_t noise = t3r_mix32(seed + (uint32_t)i);
        change_label(&all, i,
                     kind & 1   ? noise % clusters
                     : kind & 2 ? seed % (clusters + 1)
                     : kind & 4 ? T3R_MAX_CLUSTERS - 1
                                : t3r_label_of(&all, i));
        texture[i] = (uint16_t)(kind & 8 ? noise >> 16 : texture[i]);
    }
}

static void damage_clusters(t3r_runtime *rt, input *in)
{
    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    const uint32_t kind = below(in, 6), value = take32(in), count = rt->config.clusters;
    for (uint32_t k = 0; has_labels(rt) && k < count; k++) {
        switch (kind) {
        case 0:
            clusters[k].points = WIDTH * HEIGHT * 2;
            break; /* each claims all */
        case 1:
            clusters[k].points = value;
            break;
        case 2:
            clusters[k].texture_q4 = t3r_mix32(value + k) >> (value & 31);
            break;
        case 3:
            clusters[k].order = (value & 1 ? count - 1 - k : value) % (count + 1);
            break;
        case 4:
            clusters[k].texture_q4 = value & 0xffff;
            break;
        default:
            clusters[k].order = clusters[t3r_mix32(value + k) % count].order;
            break;
        }
    }
}

static void damage_scene(t3r_runtime *rt, input *in)
{
    t3r_gaussian *scene = t3r_buffer_at(rt, T3R_BUFFER_SCENE);
    const uint32_t first = below(in, BUDGET), count = below(in, 2 * BUDGET - first + 1);
    const t3r_gaussian g = take_gaussian(in);
    for (uint32_t i = first; i < first + count; i++) {
        scene[i] = g;
        scene[i].position_q20[i % 3] = (int32_t)((uint32_t)g.position_q20[i % 3] + (t3r_mix32(i) >> 12));
    }
    rt->gaussians = T3R_MIN(first + count, rt->config.gaussians);
}

static void damage_records(t3r_runtime *rt, input *in)
{
    uint8_t *records = t3r_buffer_at(rt, T3R_BUFFER_MAP_RECORDS);
    const uint32_t seed = take32(in);
    for (uint32_t i = 0; rt->config.stream && i < 2 * BUDGET * sizeof(t3r_map_record); i++) {
        records[i] = (uint8_t)t3r_mix32(seed + i);
    }
}

/* Makes redundant fields agree, some or all. */
static void mend(t3r_runtime *rt, uint32_t what)
{
    uint8_t *validity = t3r_buffer_at(rt, T3R_BUFFER_VALIDITY);
    uint16_t *depth = t3r_buffer_at(rt, T3R_BUFFER_DEPTH);
    t3r_cluster *clusters = t3r_buffer_at(rt, T3R_BUFFER_CLUSTERS);
    const size_t points = points_of(rt), viewed = (size_t)WIDTH * HEIGHT * T3R_MIN(rt->views, 3u);
    for (size_t i = 0; what & 1 && i < points; i++) {
        depth[i] = depth[i] == 0 && t3r_has_depth(validity[i]) ? 1 : depth[i];
    }
    if (!has_labels(rt)) {
        return;
    }
    const t3r_view all = all_views(rt);
    const uint32_t count = rt->config.clusters;
    for (size_t i = 0; what & 2 && i < points; i++) {
        change_label(&all, i, t3r_label_of(&all, i) % count);
    }
    for (uint32_t k = 0; what & 4 && k < count; k++) {
        clusters[k].points = 0;
        clusters[k].texture_q4 &= 0xffff;
    }
    for (size_t i = 0; what & 4 && i < viewed; i++) {
        if (t3r_has_depth(validity[i]) && t3r_label_of(&all, i) < count) {
            clusters[t3r_label_of(&all, i)].points++;
        }
    }
    if (what & 8) {
        t3r_rank_clusters(clusters, count);
    }
}

static void damage(t3r_runtime *rt, input *in)
{
    for (uint32_t n = 1 + below(in, MOST_DAMAGES); n > 0; n--) {
        switch (below(in, 10)) {
        case 0:
            damage_bytes(rt, in, true);
            return; /* fields that others rely on may be gone */
        case 1:
            damage_bytes(rt, in, false);
            return;
        case 2:
        case 3:
            damage_state(rt, in);
            break;
        case 4:
            damage_config(rt, in);
            break;
        case 5:
            damage_depth(rt, in);
            break;
        case 6:
            damage_labels(rt, in);
            break;
        case 7:
            damage_clusters(rt, in);
            break;
        case 8:
            damage_scene(rt, in);
            break;
        default:
            damage_records(rt, in);
            break;
        }
    }
    mend(rt, take8(in) % 3 == 0 ? take8(in) : 15);
}

/* ---- calls --------------------------------------------------------------------------------------- */

static uint32_t calls_until_cancelled;

static int progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    (void)user;
    REQUIRE((int)stage >= 0 && stage < T3R_STAGE_COUNT && done <= total);
    return calls_until_cancelled > 0 && --calls_until_cancelled == 0;
}

static void note_hash(void *user, t3r_stage stage, uint64_t hash)
{
    (void)hash;
    REQUIRE(user == NULL && stage < T3R_STAGE_COUNT);
}

static void backwards(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                      void *context)
{
    (void)user;
    for (uint32_t i = count; i-- > 0;) {
        task(context, i, i % 3);
    }
}

static void check_scene(const t3r_runtime *rt, t3r_status status, const t3r_scene *scene, uint32_t most)
{
    require_status(status);
    for (uint32_t i = 0; status == T3R_OK && i < scene->count; i++) {
        REQUIRE(t3r_is_gaussian(&scene->gaussians[i]));
    }
    REQUIRE(status != T3R_OK || (scene->count <= most && most <= rt->config.max_gaussians));
}

static void call_build(t3r_runtime *rt, input *in, bool again)
{
    static uint16_t plane[HEIGHT * WIDTH];
    const uint16_t *planes[T3R_MAX_VIEWS];
    const uint32_t seed = take8(in);
    for (uint32_t i = 0; i < HEIGHT * WIDTH; i++) {
        plane[i] = (uint16_t)(t3r_mix32(i + seed) >> (seed & 31));
    }
    for (uint32_t v = 0; v < T3R_MAX_VIEWS; v++) {
        planes[v] = plane;
    }
    t3r_request request = {.gaussians = below(in, 2 * BUDGET + 1),
                           .max_loss_q8 = seed % 8 == 1 ? below(in, T3R_MAX_LOSS_Q8) : 0,
                           .allocate = (t3r_allocation)below(in, T3R_ALLOCATE_COUNT),
                           .head = (t3r_head)below(in, T3R_HEAD_COUNT)};
    if (seed & 2) {
        request.allocate = T3R_ALLOCATE_GIVEN;
        request.importance = planes;
        request.importance_stride_bytes = WIDTH * 2;
    }
    t3r_scene scene;
    const t3r_status status = again ? t3r_rebuild(rt, &request, &scene) : t3r_reconstruct(rt, &request, &scene);
    check_scene(rt, status, &scene, request.gaussians != 0 ? request.gaussians : rt->config.gaussians);
}

static void call_render(t3r_runtime *rt, input *in)
{
    const t3r_camera camera = take8(in) & 1 ? take_camera(in) : camera_at(below(in, 4));
    picture drawn = picture_of(1 + below(in, WIDTH), 1 + below(in, HEIGHT), below(in, 3));
    require_status(t3r_render(rt, &camera, &drawn.target));
    free_picture(&drawn);
}

static void call_export(const t3r_runtime *rt)
{
    t3r_scene scene;
    const t3r_status status = t3r_get_scene(rt, &scene);
    check_scene(rt, status, &scene, rt->config.max_gaussians);
    if (status == T3R_OK) {
        char *text = NULL;
        size_t bytes = 0;
        FILE *file = open_memstream(&text, &bytes);
        REQUIRE(file != NULL);
        /* only read, never written */
        const scene_file made = {
            .frame = scene.frame, .gaussians = (t3r_gaussian *)(uintptr_t)scene.gaussians, .count = scene.count};
        const scene_rows rows = scene_rows_of(&made);
        const scene_source source = {
            .rows = &rows, .turn = scene_turn_between(SCENE_AXES_AS_THEY_ARE, SCENE_AXES_AS_THEY_ARE, T3R_UP_UNKNOWN)};
        char error[256];
        (void)ply_write(file, &source, error, sizeof error);
        REQUIRE(fclose(file) == 0);
        free(text);
    }
}

static void call_keyframe(t3r_runtime *rt, input *in)
{
    uint32_t overlap_q8 = 0;
    const t3r_camera camera = camera_at(below(in, 200));
    require_status(t3r_stream_overlap(rt, &camera, WIDTH, HEIGHT, &overlap_q8));
    REQUIRE(overlap_q8 <= 256);
    if (take8(in) & 1) {
        require_status(show(rt, below(in, 200)));
        return;
    }
    const t3r_camera any = take_camera(in);
    held_frame held = take_frame(in);
    t3r_stream_report report;
    require_status(t3r_stream_keyframe(rt, &held.frame, &any, &report));
    free_frame(&held);
}

static void call(t3r_runtime *rt, input *in)
{
    switch (below(in, rt->config.stream ? 16 : 12)) {
    case 0:
    case 1:
    case 2:
    case 3:
        call_build(rt, in, true);
        break;
    case 4:
    case 5:
        call_build(rt, in, false);
        break;
    case 6:
    case 7:
        call_render(rt, in);
        break;
    case 8:
        require_status(show(rt, below(in, 5)));
        break;
    case 9: {
        const t3r_gaussian g = take_gaussian(in);
        require_status(t3r_scene_append(rt, &g));
        break;
    }
    case 10: {
        uint32_t partner;
        const t3r_pair pair = t3r_stereo_pair(rt, below(in, T3R_MAX_VIEWS + 1), &partner);
        REQUIRE(t3r_pair_text(pair)[0] != '\0' && partner <= T3R_MAX_VIEWS);
        break;
    }
    case 11:
        if (take8(in) % 8 == 0) {
            require_status(t3r_reset(rt));
        }
        break;
    default:
        call_keyframe(rt, in);
        break;
    }
    call_export(rt);
    (void)t3r_render_passes(rt);
    (void)t3r_head_crc(rt);
    REQUIRE(t3r_get_config(rt) != NULL);
}

static void use(t3r_runtime *rt, input *in)
{
    static uint8_t *weights;
    static size_t weights_bytes;
    if (weights == NULL) {
        static const made_layer shape[] = {{T3R_LAYER_CONV, 1, {T3R_SOURCE_FEATURES, T3R_SOURCE_NONE}, 3, 2, 1, 4},
                                           {T3R_LAYER_POINT, 0, {T3R_SOURCE_FEATURES, 1}, 1, 1, 1, T3R_HEAD_OUTPUTS}};
        weights = make_weights(shape, 2, 8, 8, 1, &weights_bytes);
        REQUIRE(t3r_weights_error(weights, weights_bytes) == NULL);
    }
    const uint32_t kind = take8(in);
    if (kind % 4 == 3) {
        require_status(t3r_bind_head(rt, weights, weights_bytes));
    }
    calls_until_cancelled = kind & 1 ? kind >> 3 : 0;
    const t3r_hooks hooks = {
        .progress = progress, .stage_hash = kind & 2 ? note_hash : NULL, .parallel_for = kind & 4 ? backwards : NULL};
    REQUIRE(t3r_set_hooks(rt, &hooks) == T3R_OK);
    const t3r_runtime before = *rt;
    for (uint32_t i = 0; i < MOST_CALLS && (i == 0 || in->left > 0); i++) {
        call(rt, in);
        REQUIRE(memcmp(rt->offset, before.offset, sizeof before.offset) == 0);
        REQUIRE(memcmp(&rt->config, &before.config, sizeof before.config) == 0);
        REQUIRE(rt->list_capacity == before.list_capacity && rt->refine_bytes == before.refine_bytes);
    }
}

int LLVMFuzzerTestOneInput(const uint8_t *bytes, size_t count)
{
    static stored bases[BASES];
    input in = {bytes, count};
    stored *sound = &bases[below(&in, BASES)];
    if (sound->arena == NULL) {
        *sound = make((base)(sound - bases));
    }
    uint8_t *arena = allocate_arena(sound->bytes);
    memcpy(arena, sound->arena, sound->bytes);
    damage((t3r_runtime *)(void *)arena, &in);
    t3r_runtime *rt;
    const t3r_status status = t3r_attach(&rt, arena, sound->bytes);
    require_status(status);
    REQUIRE((rt != NULL) == (status == T3R_OK));
    if (rt != NULL) {
        use(rt, &in);
    }
    free(arena);
    return 0;
}
