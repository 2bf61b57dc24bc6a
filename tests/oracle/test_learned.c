/* SPDX-License-Identifier: Apache-2.0 */
/* The learned head through the C interface: binding weights, the same bits in every arena, what its outputs mean. */
#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "head/head_views.h"
#include "oracle/float64/drawing.h"
#include "rgbd_frame.h"
#include "sanitized.h"
#include "stages.h"
#include "state/ablation.h"
#include "state/state.h"
#include "test.h"
#include "weights_maker.h"

enum { W = 45, H = 34, POINTS = W * H };

static uint8_t colours[POINTS * 3], depths[POINTS * 2];

/* Returns a slanted plane with made-up colours, partly without depth. */
static t3r_frame made_up_frame(int holes)
{
    for (size_t i = 0; i < POINTS; i++) {
        uint32_t step = (uint32_t)(1500 + i % W * 4 + i / W * 3);
        step = holes && (i % 31 == 0 || (i % W < 9 && i / W > 20)) ? 0 : step;
        depths[i * 2] = (uint8_t)step;
        depths[i * 2 + 1] = (uint8_t)(step >> 8);
        for (size_t c = 0; c < 3; c++) {
            colours[i * 3 + c] = (uint8_t)(i * (7 + c) + (i / W) * 13 + (i * i >> 5));
        }
    }
    return rgbd_frame(colours, depths, W, H, MILLIMETRE_Q40);
}

static t3r_config learned_config(uint32_t gaussians)
{
    t3r_config c = t3r_default_config(W, H, 2, gaussians);
    c.rim = 0;
    c.clusters = 9;
    c.cluster_batches = 24;
    c.head = T3R_HEAD_LEARNED;
    c.head_column_bytes = SMALL_SHAPE_COLUMN_BYTES;
    c.refine = c.fit_widths = 0;
    c.keep_analysis = 1;
    return c;
}

static t3r_runtime *with_views(const arena *memory, const t3r_config *config, int holes)
{
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, memory->bytes, memory->count, config), T3R_OK);
    t3r_frame frame = made_up_frame(holes);
    t3r_camera camera = plain_camera(40, W, H);
    for (uint32_t v = 0; v < config->views; v++) {
        camera.position_q32[0] = (int64_t)v << 28;
        assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
    }
    return rt;
}

static void same_scene(const t3r_scene *a, const t3r_scene *b)
{
    assert_int_equal(a->count, b->count);
    assert_memory_equal(a->gaussians, b->gaussians, a->count * sizeof *a->gaussians);
}

/* Every width of weights and activations; arenas of all sizes, with any contents; a moved arena; budgets in between. */
TEST(same_bits_everywhere)
{
    for (uint32_t bits = 0; bits < 4; bits++) {
        size_t bytes;
        uint8_t *weights =
            make_weights(small_shape, small_layers, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8, 40 + bits, &bytes);
        t3r_config config = learned_config(400);
        config.head_column_bytes = t3r_head_column_bytes(weights, bytes, W);
        arena first = arena_of(&config, ARENA_AT_FULL);
        t3r_runtime *rt = with_views(&first, &config, 1);
        t3r_scene expected, scene;
        assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
        assert_int_equal(t3r_reconstruct(rt, NULL, &expected), T3R_OK);
        assert_int_equal(expected.count, 400);
        uint32_t different = 0;
        for (uint32_t i = 1; i < expected.count; i++) { /* the network's output varies */
            different += expected.gaussians[i].opacity_q15 != expected.gaussians[i - 1].opacity_q15;
        }
        assert_true(different > expected.count / 2);
        const int sizes[] = {ARENA_AT_MINIMUM, ARENA_AT_TEN_TIMES};
        for (int i = 0; i < 2; i++) {
            arena other = arena_of(&config, sizes[i]), moved = arena_of_bytes(other.count);
            memset(other.bytes, 0x7e, other.count);
            rt = with_views(&other, &config, 1);
            assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
            same_scene(&scene, &expected);
            assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = 123}, &scene), T3R_OK);
            memcpy(moved.bytes, other.bytes, other.count);
            assert_int_equal(t3r_attach(&rt, moved.bytes, moved.count), T3R_OK);
            assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_ERR_STATE); /* weights do not move along */
            assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
            assert_int_equal(t3r_rebuild(rt, NULL, &scene), T3R_OK);
            same_scene(&scene, &expected);
            arena_free(&moved);
            arena_free(&other);
        }
        arena_free(&first);
        free(weights);
    }
}

/* Two readers of the features with receptive fields of different sizes, a depthwise layer, and a layer that reads only
 * a coarser one. */
static const made_layer odd_shape[] = {
    {T3R_LAYER_CONV, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 4},
    {T3R_LAYER_CONV, 0, {0, T3R_SOURCE_NONE}, 5, 1, 1, 4},
    {T3R_LAYER_CONV, 1, {1, 2}, 3, 2, 1, 8},
    {T3R_LAYER_DEPTHWISE, 1, {3, T3R_SOURCE_NONE}, 3, 1, 1, 8},
    {T3R_LAYER_CONV, 0, {4, T3R_SOURCE_NONE}, 3, 1, 1, 16},
    {T3R_LAYER_POINT, 0, {5, 0}, 1, 1, 1, T3R_HEAD_OUTPUTS},
};
static const uint32_t odd_layers = sizeof odd_shape / sizeof odd_shape[0];

/* A view made in bands, each in its own work memory with any contents, has the same Gaussians as the whole view. */
TEST(bands_give_the_whole_view)
{
    static const struct {
        const made_layer *layers;
        const uint32_t *count;
    } shapes[] = {{small_shape, &small_layers}, {wide_shape, &wide_layers}, {odd_shape, &odd_layers}};
    t3r_config config = learned_config(500);
    config.head = T3R_HEAD_ANALYTIC;
    arena memory = arena_of(&config, ARENA_AT_FULL);
    t3r_runtime *rt = with_views(&memory, &config, 1);
    t3r_scene scene;
    t3r_view views[T3R_MAX_VIEWS];
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    t3r_views_of(rt, views);
    const t3r_budget_settings settings = t3r_budget_settings_of(rt, views);
    t3r_head_input input = t3r_head_input_of(rt, views, 0, &settings);
    t3r_gaussian *whole = malloc(POINTS * sizeof *whole), *bands = malloc(POINTS * sizeof *bands);
    t3r_head_rows *const heads[] = {t3r_head_analytic, t3r_head_learned};
    enum { ROUNDS = T3R_SANITIZED ? 36 : 180 }; /* 36 rounds cover every shape, width and kind of band */
    uint32_t random = 1;
    for (uint32_t round = 0; round < ROUNDS; round++) {
        const uint32_t bits = round / 3 % 4;
        size_t bytes;
        uint8_t *weights = make_weights(shapes[round % 3].layers, *shapes[round % 3].count, bits & 1 ? 16 : 8,
                                        bits & 2 ? 16 : 8, round, &bytes);
        const size_t work_bytes = t3r_head_learned_work_bytes(weights, W);
        t3r_head_rows *head = heads[round < 8 ? round / 2 % 2 : 1];
        input.unadapted = round / 12 % 3 == 1;
        input.weights = weights;
        input.work = aligned_alloc(16, (work_bytes + 15) / 16 * 16);
        input.work_bytes = work_bytes;
        memset(input.work, 0x5a, work_bytes);
        const uint32_t count = head(&input, 0, H, whole);
        assert_true(count > 100);
        uint32_t made = 0, end;
        for (uint32_t begin = 0; begin < H; begin = end) {
            random = random * 1664525 + 1013904223;
            end = begin + 1 + (random >> 16) % (round % 8 == 0 ? 1 : H - begin);
            memset(input.work, (int)round, work_bytes);
            made += head(&input, begin, end, bands + made);
        }
        assert_int_equal(made, count);
        assert_memory_equal(bands, whole, count * sizeof *whole);
        free(input.work);
        free(weights);
    }
    free(bands);
    free(whole);
    arena_free(&memory);
}

/* A network whose work fits into the kernels' memory still needs one byte per column: 0 means no learned head. */
TEST(least_room_for_a_head)
{
    static const made_layer least[] = {{T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS}};
    size_t bytes;
    uint8_t *weights = make_weights(least, 1, 8, 8, 3, &bytes);
    assert_true(t3r_head_learned_work_bytes(weights, W) <= T3R_HEAD_KERNEL_BYTES);
    t3r_config config = learned_config(100);
    config.head_column_bytes = t3r_head_column_bytes(weights, bytes, W);
    assert_int_equal(config.head_column_bytes, 1);
    arena memory = arena_of(&config, ARENA_AT_MINIMUM);
    t3r_runtime *rt = with_views(&memory, &config, 0);
    t3r_scene scene;
    assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_int_equal(scene.count, 100);
    arena_free(&memory);
    free(weights);
}

/* Heads shipped by earlier versions, by their layers, can still be bound in an arena made for them. */
TEST(heads_that_are_not_shipped)
{
#define U_NET(A, B, C, HIDDEN)                                                                                         \
    {                                                                                                                  \
        {T3R_LAYER_CONV, 1, {0, T3R_SOURCE_NONE}, 4, 2, 1, A}, {T3R_LAYER_CONV, 1, {1, T3R_SOURCE_NONE}, 3, 1, 1, A},  \
            {T3R_LAYER_CONV, 2, {2, T3R_SOURCE_NONE}, 3, 2, 1, B},                                                     \
            {T3R_LAYER_CONV, 2, {3, T3R_SOURCE_NONE}, 3, 1, 1, B},                                                     \
            {T3R_LAYER_CONV, 3, {4, T3R_SOURCE_NONE}, 3, 2, 1, C},                                                     \
            {T3R_LAYER_CONV, 3, {5, T3R_SOURCE_NONE}, 3, 1, 1, C}, {T3R_LAYER_CONV, 2, {4, 6}, 1, 1, 1, B},            \
            {T3R_LAYER_CONV, 2, {7, T3R_SOURCE_NONE}, 3, 1, 1, B}, {T3R_LAYER_CONV, 1, {2, 8}, 1, 1, 1, A},            \
            {T3R_LAYER_CONV, 1, {9, T3R_SOURCE_NONE}, 3, 1, 1, A}, {T3R_LAYER_POINT, 0, {10, 0}, 1, 1, 4, HIDDEN},     \
            {T3R_LAYER_POINT, 0, {11, T3R_SOURCE_NONE}, 1, 1, 1, T3R_HEAD_OUTPUTS},                                    \
    }
    static const made_layer nets[2][12] = {U_NET(8, 16, 16, 10), U_NET(40, 44, 32, 32)}; /* `nano`, `base` */
#undef U_NET
    for (uint32_t n = 0; n < 2; n++) {
        size_t bytes;
        uint8_t *weights = make_weights(nets[n], 12, 8, 8, 9, &bytes);
        assert_null(t3r_weights_error(weights, bytes));
        t3r_config config = learned_config(100);
        config.head_column_bytes = t3r_head_column_bytes(weights, bytes, W);
        assert_int_equal(config.head_column_bytes > T3R_HEAD_COLUMN_BYTES, n);
        arena memory = arena_of(&config, ARENA_AT_MINIMUM);
        t3r_runtime *rt = with_views(&memory, &config, 0);
        t3r_scene scene;
        assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        assert_int_equal(scene.count, 100);
        arena_free(&memory);
        free(weights);
    }
}

/* head_column_bytes: the result of t3r_head_column_bytes() suffices and is minimal, for any width; 0 holds no head. */
TEST(room_for_the_head)
{
    size_t bytes;
    uint8_t *weights = make_weights(wide_shape, wide_layers, 8, 16, 3, &bytes);
    assert_int_equal(t3r_head_column_bytes(NULL, 0, 64), 0);
    assert_int_equal(t3r_head_column_bytes(weights, bytes - 16, 64), 0);
    assert_int_equal(t3r_head_column_bytes(weights, bytes, 0), 0);
    assert_int_equal(t3r_head_column_bytes(weights, bytes, T3R_MAX_SIDE + 1), 0);
    for (uint32_t width = T3R_MIN_SIDE; width <= 200; width += 1 + width / 40) {
        t3r_config config = t3r_default_config(width, T3R_MIN_SIDE, 1, 10);
        uint32_t least = t3r_head_column_bytes(weights, bytes, width);
        assert_true(least > T3R_HEAD_COLUMN_BYTES && least <= T3R_MAX_HEAD_COLUMN_BYTES);
        const uint32_t rooms[] = {least, least - 1, 0};
        for (size_t i = 0; i < sizeof rooms / sizeof rooms[0]; i++) {
            t3r_runtime *rt;
            config.head_column_bytes = rooms[i];
            arena memory = arena_of(&config, ARENA_AT_MINIMUM);
            assert_int_equal(t3r_init(&rt, memory.bytes, memory.count, &config), T3R_OK);
            assert_int_equal(t3r_bind_head(rt, weights, bytes), i > 0 ? T3R_ERR_WEIGHTS : T3R_OK);
            arena_free(&memory);
        }
    }
    free(weights);
}

/* Whether each Gaussian of `few` is one of `all`, in the same order. */
static void is_part_of(const t3r_scene *few, const t3r_gaussian *all, uint32_t count)
{
    uint32_t at = 0;
    for (uint32_t i = 0; i < few->count; i++, at++) {
        while (at < count && memcmp(&all[at], &few->gaussians[i], sizeof *all) != 0) {
            at++;
        }
        assert_true(at < count);
    }
}

/* A head without adaptation makes all points' Gaussians and drops some unchanged; a head with adaptation makes another
 * scene. */
TEST(unadapted_is_pruned)
{
    static t3r_gaussian all[2 * POINTS], adapted[300];
    size_t bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 5, &bytes);
    const t3r_head heads[] = {T3R_HEAD_ANALYTIC, T3R_HEAD_LEARNED};
    for (uint32_t h = 0; h < 2; h++) {
        t3r_config config = learned_config(2 * POINTS);
        config.head = heads[h];
        config.allocate = T3R_ALLOCATE_UNIFORM;        /* at 100 % the density is 1 everywhere */
        config.fill_radius = config.bridge_radius = 0; /* filled points do not displace measured ones */
        arena memory = arena_of(&config, ARENA_AT_FULL);
        uint32_t count = 0;
        const t3r_request fewer = {.gaussians = 300, .allocate = T3R_ALLOCATE_DENSITY};
        for (uint32_t unadapted = 0; unadapted < 2; unadapted++) {
            t3r_runtime *rt = with_views(&memory, &config, 1);
            t3r_scene scene;
            assert_int_equal(t3r_set_ablation(rt, &(t3r_ablation){.unadapted = unadapted}), T3R_OK);
            assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
            if (!unadapted) {
                count = scene.count;
                memcpy(all, scene.gaussians, count * sizeof *all);
            } else {
                assert_int_equal(scene.count, count);
                assert_memory_equal(all, scene.gaussians, count * sizeof *all);
            }
            assert_int_equal(t3r_rebuild(rt, &fewer, &scene), T3R_OK);
            assert_int_equal(scene.count, 300);
            if (!unadapted) {
                memcpy(adapted, scene.gaussians, sizeof adapted);
            } else {
                is_part_of(&scene, all, count);
                assert_memory_not_equal(adapted, scene.gaussians, sizeof adapted);
            }
        }
        arena_free(&memory);
    }
    free(weights);
}

static uint64_t told_hash;

static void note_head_hash(void *user, t3r_stage stage, uint64_t hash)
{
    (void)user;
    told_hash = stage == T3R_STAGE_HEAD ? hash : told_hash;
}

/* Heads that differ only in their name make the same Gaussians; the stage's hash differs. */
TEST(hash_names_the_weights)
{
    static t3r_gaussian first[100];
    uint64_t hashes[2];
    size_t bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 5, &bytes);
    t3r_config config = learned_config(100);
    arena memory = arena_of(&config, ARENA_AT_FULL);
    const t3r_hooks hooks = {.stage_hash = note_head_hash};
    for (int i = 0; i < 2; i++) {
        t3r_runtime *rt = with_views(&memory, &config, 1);
        t3r_scene scene;
        weights[32] = (uint8_t)('a' + i);
        seal_weights(weights, bytes);
        assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
        assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        assert_int_equal(scene.count, 100);
        hashes[i] = told_hash;
        if (i == 0) {
            memcpy(first, scene.gaussians, sizeof first);
        } else {
            assert_memory_equal(first, scene.gaussians, sizeof first);
        }
    }
    assert_true(hashes[0] != hashes[1]);
    arena_free(&memory);
    free(weights);
}

TEST(binding)
{
    const made_layer wide[] = {
        {T3R_LAYER_CONV, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 128},
        {T3R_LAYER_DEPTHWISE, 0, {1, T3R_SOURCE_NONE}, 5, 1, 1, 128},
        {T3R_LAYER_POINT, 0, {2, T3R_SOURCE_NONE}, 1, 1, 1, 9},
    };
    size_t bytes, wide_bytes;
    uint8_t *weights = make_weights(small_shape, small_layers, 8, 8, 1, &bytes);
    uint8_t *too_large = make_weights(wide, 3, 8, 16, 1, &wide_bytes);
    t3r_config config = learned_config(100);
    arena memory = arena_of(&config, ARENA_AT_MINIMUM);
    t3r_runtime *rt = with_views(&memory, &config, 0);
    t3r_scene scene;
    assert_int_equal(t3r_bind_head(NULL, weights, bytes), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_head_crc(NULL), 0);
    assert_int_equal(t3r_head_crc(rt), 0);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_bind_head(rt, weights + 8, bytes - 8), T3R_ERR_ARGUMENT);
    assert_int_equal(t3r_bind_head(rt, weights, bytes - 16), T3R_ERR_WEIGHTS);
    assert_int_equal(t3r_bind_head(rt, too_large, wide_bytes), T3R_ERR_WEIGHTS);
    assert_null(t3r_weights_error(too_large, wide_bytes));
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_ERR_STATE);

    assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
    uint32_t crc = t3r_head_crc(rt);
    assert_int_not_equal(crc, 0);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_int_equal(t3r_bind_head(rt, too_large, wide_bytes), T3R_ERR_WEIGHTS); /* the bound head stays */
    assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = 50}, &scene), T3R_OK);
    assert_int_equal(t3r_bind_head(rt, NULL, 0), T3R_OK);
    assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = 50}, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = 50, .head = T3R_HEAD_ANALYTIC}, &scene), T3R_OK);
    assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = 50, .head = T3R_HEAD_LEARNED}, &scene), T3R_ERR_STATE);
    assert_int_equal(t3r_get_scene(rt, &scene), T3R_OK); /* refused before any change */
    assert_int_equal(t3r_attach(&rt, memory.bytes, memory.count), T3R_OK);
    assert_int_equal(t3r_head_crc(rt), crc);

    t3r_config only_renders = render_config(10, W, H);
    arena small = arena_of(&only_renders, ARENA_AT_MINIMUM);
    assert_int_equal(t3r_init(&rt, small.bytes, small.count, &only_renders), T3R_OK);
    assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_ERR_STATE);
    arena_free(&small);
    arena_free(&memory);
    free(too_large);
    free(weights);
}

/* --- meaning of the outputs --------------------------------------------------------------------------------------- */

static t3r_gaussian constant_scene[POINTS];

/* Every pixel is retained, and one point layer has no weights: its biases are the outputs. */
static const t3r_gaussian *constant_head(const int16_t outputs[T3R_HEAD_OUTPUTS], t3r_head head)
{
    const made_layer one[] = {{T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 9}};
    size_t bytes;
    uint8_t *weights = make_weights(one, 1, 8, 8, 1, &bytes);
    t3r_layer layer = t3r_weights_layer(weights, 0);
    memset(weights + layer.weights, 0, 9 * T3R_FEATURES);
    for (uint32_t o = 0; o < 9; o++) {
        const uint32_t numbers[2] = {(uint32_t)(int32_t)outputs[o], 1u << 30};
        for (uint32_t b = 0; b < 4; b++) {
            weights[layer.bias + 4 * o + b] = (uint8_t)(numbers[0] >> (8 * b));
            weights[layer.multiplier + 4 * o + b] = (uint8_t)(numbers[1] >> (8 * b));
        }
        weights[layer.shift + o] = 1; /* x 2^30 / 2^30 */
    }
    seal_weights(weights, bytes);
    t3r_config config = learned_config(POINTS);
    config.views = 1;
    config.gamma_q8 = 0; /* uniform density */
    config.head = head;
    arena memory = arena_of(&config, ARENA_AT_MINIMUM);
    t3r_runtime *rt = with_views(&memory, &config, 0);
    t3r_scene scene;
    assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_int_equal(scene.count, POINTS);
    memcpy(constant_scene, scene.gaussians, sizeof constant_scene);
    arena_free(&memory);
    free(weights);
    return constant_scene;
}

TEST(colour_and_opacity)
{
    const struct {
        int16_t out;
        int32_t opacity;
    } opacities[] = {{20000, 20000}, {32767, 32440}, {32440, 32440}, {0, 0}, {-1, 0}, {-32768, 0}};
    for (size_t k = 0; k < sizeof opacities / sizeof *opacities; k++) {
        int16_t out[T3R_HEAD_OUTPUTS] = {0};
        out[T3R_OUT_OPACITY] = opacities[k].out;
        out[T3R_OUT_RED] = 1234;
        out[T3R_OUT_GREEN] = -20000;
        out[T3R_OUT_BLUE] = (int16_t)(k % 2 == 0 ? 32767 : -32768);
        const t3r_gaussian *g = constant_head(out, T3R_HEAD_LEARNED);
        for (uint32_t i = 0; i < POINTS; i++) {
            assert_int_equal(g[i].opacity_q15, opacities[k].opacity);
            for (int c = 0; c < 3; c++) {
                int32_t want = colours[3 * i + (size_t)c] * 128 + out[T3R_OUT_RED + c];
                assert_int_equal(g[i].colour_q7[c], want < 0 ? 0 : want > 32640 ? 32640 : want);
            }
        }
    }
}

static void difference(const t3r_gaussian *a, const t3r_gaussian *b, double d[3])
{
    for (int i = 0; i < 3; i++) {
        d[i] = (b->position_q20[i] - a->position_q20[i]) * 0x1p-20;
    }
}

static double product(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Computes the Gaussian's covariance in the coordinates of the tangents tu and tv, px^2: xx, xy, yy. */
static void in_the_image(const t3r_gaussian *g, const double tu[3], const double tv[3], double s[3])
{
    double uu = product(tu, tu), uv = product(tu, tv), vv = product(tv, tv), det = uu * vv - uv * uv;
    double du[3], dv[3];
    for (int i = 0; i < 3; i++) {
        du[i] = (vv * tu[i] - uv * tv[i]) / det;
        dv[i] = (uu * tv[i] - uv * tu[i]) / det;
    }
    s[0] = s[1] = s[2] = 0;
    for (int k = 0; k < 3; k++) {
        double column[3];
        for (int i = 0; i < 3; i++) {
            column[i] = ldexp(g->factor[3 * i + k], g->factor_exponent);
        }
        double a = product(column, du), b = product(column, dv);
        s[0] += a * a;
        s[1] += a * b;
        s[2] += b * b;
    }
}

/* Footprints against doubles; the spacing is one pixel, as all points are kept. */
TEST(footprints)
{
    static t3r_gaussian centres[POINTS];
    int16_t out[T3R_HEAD_OUTPUTS] = {0};
    memcpy(centres, constant_head(out, T3R_HEAD_LEARNED), sizeof centres);
    const struct {
        double x, y, l11, l21, l22;
    } wanted[] = {{0.5, -0.25, 1, 0, 1}, {-1.75, 1.5, 2, 1, 1.5}, {0, 0, 3, -1.9, 0.8},
                  {1, 1, 0.7, 0.4, 2.5}, {0, 0, 15.5, 0, 15.5},   {0, 0, 0.07, 0, 0.07}};
    for (size_t k = 0; k < sizeof wanted / sizeof *wanted; k++) {
        double l11 = wanted[k].l11, l21 = wanted[k].l21, l22 = wanted[k].l22;
        out[T3R_OUT_OFFSET_X] = (int16_t)lrint(wanted[k].x * 0x1p14);
        out[T3R_OUT_OFFSET_Y] = (int16_t)lrint(wanted[k].y * 0x1p14);
        out[T3R_OUT_LOG_L11] = (int16_t)lrint(log2(l11) * 0x1p13);
        out[T3R_OUT_LOG_L22] = (int16_t)lrint(log2(l22) * 0x1p13);
        out[T3R_OUT_L21] = (int16_t)lrint(l21 * 0x1p14);
        const t3r_gaussian *g = constant_head(out, T3R_HEAD_LEARNED);
        double xx = fmax(l11 * l11 - 0.3, 0.02), xy = l11 * l21, yy = fmax(l21 * l21 + l22 * l22 - 0.3, 0.02);
        yy = fmax(yy, xy * xy / xx + 0.02); /* t3r_lift() keeps it positive definite */
        for (uint32_t y = 3; y < H - 3; y += 5) {
            for (uint32_t x = 3; x < W - 3; x += 5) {
                uint32_t i = y * W + x;
                double left[3], right[3], up[3], down[3], tu[3], tv[3], moved[3], s[3];
                difference(&centres[i - 1], &centres[i], left);
                difference(&centres[i], &centres[i + 1], right);
                difference(&centres[i - W], &centres[i], up);
                difference(&centres[i], &centres[i + W], down);
                for (int c = 0; c < 3; c++) {
                    tu[c] = (left[c] + right[c]) / 2;
                    tv[c] = (up[c] + down[c]) / 2;
                }
                difference(&centres[i], &g[i], moved);
                double pixel = sqrt(product(tu, tu));
                for (int c = 0; c < 3; c++) {
                    double want = wanted[k].x * tu[c] + wanted[k].y * tv[c];
                    assert_true(fabs(moved[c] - want) < 0.02 * pixel);
                }
                in_the_image(&g[i], tu, tv, s);
                double most = xx > yy ? xx : yy;
                if (fabs(s[0] - xx) > 0.03 * most || fabs(s[1] - xy) > 0.03 * most || fabs(s[2] - yy) > 0.03 * most) {
                    fail_msg("footprint %zu at %u, %u: %.3f %.3f %.3f, wanted %.3f %.3f %.3f", k, x, y, s[0], s[1],
                             s[2], xx, xy, yy);
                }
            }
        }
    }
}

/* Outputs are in units of the spacing: with a tenth of the points a constant head that copies `analytic` gives its
 * discs. */
TEST(scaled_by_the_spacing)
{
    const made_layer one[] = {{T3R_LAYER_POINT, 0, {0, T3R_SOURCE_NONE}, 1, 1, 1, 9}};
    size_t bytes;
    uint8_t *weights = make_weights(one, 1, 8, 8, 1, &bytes);
    t3r_layer layer = t3r_weights_layer(weights, 0);
    memset(weights + layer.weights, 0, 9 * T3R_FEATURES);
    memset(weights + layer.bias, 0, 4 * 9);
    for (uint32_t o = 0; o < 9; o++) {
        uint32_t log = o == T3R_OUT_LOG_L11 || o == T3R_OUT_LOG_L22 ? (uint32_t)(int32_t)lrint(log2(0.6) * 0x1p13) : 0;
        for (uint32_t b = 0; b < 4; b++) {
            weights[layer.bias + 4 * o + b] = (uint8_t)(log >> (8 * b));
            weights[layer.multiplier + 4 * o + b] = (uint8_t)((1u << 30) >> (8 * b));
        }
        weights[layer.shift + o] = 1;
    }
    seal_weights(weights, bytes);
    t3r_config config = learned_config(POINTS / 10);
    arena memory = arena_of(&config, ARENA_AT_MINIMUM);
    t3r_runtime *rt = with_views(&memory, &config, 1);
    static t3r_gaussian learned[POINTS];
    t3r_scene scene;
    assert_int_equal(t3r_bind_head(rt, weights, bytes), T3R_OK);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    memcpy(learned, scene.gaussians, scene.count * sizeof *learned);
    assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = POINTS / 10, .head = T3R_HEAD_ANALYTIC}, &scene),
                     T3R_OK);
    assert_int_equal(scene.count, POINTS / 10);
    for (uint32_t i = 0; i < scene.count; i++) {
        const t3r_gaussian *a = &scene.gaussians[i], *b = &learned[i];
        assert_memory_equal(a->position_q20, b->position_q20, sizeof a->position_q20);
        double size = 0, error = 0;
        for (int k = 0; k < 9; k++) {
            double fa = ldexp(a->factor[k], a->factor_exponent), fb = ldexp(b->factor[k], b->factor_exponent);
            size += fa * fa;
            error += (fa - fb) * (fa - fb);
        }
        assert_true(error < 1e-4 * size);
    }
    arena_free(&memory);
    free(weights);
}
