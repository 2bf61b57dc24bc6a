/* SPDX-License-Identifier: Apache-2.0 */
/* The arena's guarantees: the macros and t3r_plan() agree, the minimum works and one byte less is refused, any size
 * gets an answer without an access beyond it, and buffers in use at the same time never share a byte. */
#include <limits.h>
#include <stdlib.h>
#include <string.h>

#include "core/config.h"
#include "oracle/float64/drawing.h"
#include "test.h"

/* The embedded default: what a firmware declares. */
enum {
    LEAST = T3R_ARENA_MIN_BYTES(256, 256, 2, 13107),
    FULL = T3R_ARENA_BYTES(256, 256, 2, 13107),
    STEREO_LEAST = T3R_STEREO_ARENA_MIN_BYTES(256, 256, 2, 13107),
    STEREO_FULL = T3R_STEREO_ARENA_BYTES(256, 256, 2, 13107),
};
_Static_assert(FULL <= 4 << 20, "full arena over 4 MiB");
_Static_assert(LEAST <= 5 << 19, "minimum arena over 2.5 MiB");
_Static_assert(LEAST <= FULL, "minimum over full");
_Static_assert(STEREO_FULL <= 5 << 20, "arena with stereo over 5 MiB");
_Static_assert(STEREO_LEAST <= STEREO_FULL, "minimum with stereo over full");
static _Alignas(T3R_ARENA_ALIGN) uint8_t firmware_arena[T3R_ARENA_BYTES(96, 96, 2, 900)];

static uint32_t log_uniform(dice *d, uint32_t low, uint32_t high)
{
    uint32_t bits = 0;
    while (bits < 31 && high >> bits > 1) {
        bits++;
    }
    uint32_t x = 0;
    do {
        x = dice_below(d, 2u << dice_below(d, bits + 1));
    } while (x < low || x > high);
    return x;
}

static t3r_config random_config(dice *d, uint32_t most_side, uint32_t most_gaussians)
{
    t3r_config c = t3r_default_config(log_uniform(d, T3R_MIN_SIDE, most_side), log_uniform(d, T3R_MIN_SIDE, most_side),
                                      dice_below(d, T3R_MAX_VIEWS + 1), log_uniform(d, 1, most_gaussians));
    c.gaussians = log_uniform(d, 1, c.max_gaussians);
    c.render_width = log_uniform(d, 1, most_side);
    c.render_height = log_uniform(d, 1, most_side);
    c.clusters = log_uniform(d, 1, T3R_MAX_CLUSTERS);
    c.levels = 1 + dice_below(d, T3R_MAX_LEVELS);
    c.wavelet = (t3r_wavelet)dice_below(d, T3R_WAVELET_COUNT);
    c.keep_analysis = dice_below(d, 2);
    c.refine = dice_below(d, 3);
    c.fill_radius = dice_below(d, 9);
    c.bridge_radius = dice_below(d, 256);
    c.depth = c.width < T3R_STEREO_LEAST_SIDE || c.height < T3R_STEREO_LEAST_SIDE
                  ? T3R_DEPTH_SENSOR
                  : (t3r_depth)dice_below(d, T3R_DEPTH_COUNT);
    c.head_column_bytes = dice_below(d, 3) == 0 ? log_uniform(d, 1, T3R_MAX_HEAD_COLUMN_BYTES) : dice_below(d, 2) * 704;
    return c;
}

static void check_plan(const t3r_plan_info *plan)
{
    assert_true(plan->min_bytes <= plan->bytes);
    assert_true(plan->min_bytes >= T3R_HEADER_BYTES);
    assert_int_equal(plan->buffer_count, T3R_BUFFER_COUNT);
    size_t peak[T3R_STAGE_COUNT] = {0};
    for (uint32_t i = 0; i < plan->buffer_count; i++) {
        const t3r_plan_buffer *a = &plan->buffers[i];
        assert_non_null(a->name);
        assert_true(a->name[0] != '\0');
        assert_true(a->first <= a->last && a->last < T3R_STAGE_COUNT);
        assert_int_equal(a->offset % T3R_ARENA_ALIGN, 0);
        assert_true(a->bytes <= plan->bytes && a->offset <= plan->bytes - a->bytes);
        for (int stage = (int)a->first; stage <= (int)a->last; stage++) {
            peak[stage] += a->bytes;
        }
        for (uint32_t j = 0; j < i; j++) {
            const t3r_plan_buffer *b = &plan->buffers[j];
            int one_time = a->first <= b->last && b->first <= a->last;
            int one_place = a->offset < b->offset + b->bytes && b->offset < a->offset + a->bytes;
            if (one_time && one_place && a->bytes > 0 && b->bytes > 0) {
                fail_msg("'%s' and '%s' share bytes and a stage", a->name, b->name);
            }
        }
    }
    for (int stage = 0; stage < T3R_STAGE_COUNT; stage++) {
        assert_true(peak[stage] <= plan->bytes);
    }
}

TEST(plan_equals_macros)
{
    dice d = {1};
    for (int i = 0; i < 20000; i++) {
        t3r_config c = random_config(&d, T3R_MAX_SIDE, T3R_MAX_GAUSSIANS);
        c.stream = c.views > 0 && c.depth == T3R_DEPTH_SENSOR && dice_below(&d, 4) == 0;
        c.workers = 1 + dice_below(&d, T3R_MAX_WORKERS);
        c.warm = c.depth == T3R_DEPTH_SENSOR && dice_below(&d, 2) == 0;
        c.remember = dice_below(&d, T3R_MAX_REMEMBERED + 1);
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&c, &plan), T3R_OK);
        check_plan(&plan);
        assert_true(plan.bytes <= t3r_most_arena_bytes(&c)); /* refused where size_t is small */
        const uint32_t keep = c.stream ? T3R_KEEP_MAP : c.keep_analysis;
#define SHAPE                                                                                                          \
    T3R_SHAPE_(c.width, c.height, c.views, c.max_gaussians, c.stream ? 1 : c.clusters, c.render_width,                 \
               c.render_height, c.head_column_bytes, keep, c.refine, c.depth == T3R_DEPTH_STEREO, c.workers, c.warm,   \
               c.remember)
        assert_true(plan.min_bytes == T3R_MIN_BYTES_(SHAPE));
        assert_true(plan.bytes == T3R_FULL_BYTES_(SHAPE));
#undef SHAPE
        /* the macros are for the defaults */
        c = t3r_default_config(c.width, c.height, c.views, c.max_gaussians);
        assert_int_equal(t3r_plan(&c, &plan), T3R_OK);
        assert_true(plan.min_bytes == T3R_ARENA_MIN_BYTES(c.width, c.height, c.views, c.max_gaussians));
        assert_true(plan.bytes == T3R_ARENA_BYTES(c.width, c.height, c.views, c.max_gaussians));
        c.stream = c.views > 0;
        if (c.stream) {
            const size_t least = T3R_STREAM_MIN_BYTES(c.width, c.height, c.views, c.max_gaussians);
            const size_t full = T3R_STREAM_BYTES(c.width, c.height, c.views, c.max_gaussians);
            for (c.remember = 0; c.remember <= 3; c.remember += 3) {
                const size_t more = c.remember * T3R_REMEMBERED_BYTES(c.width, c.height);
                assert_int_equal(t3r_plan(&c, &plan), T3R_OK);
                assert_true(plan.min_bytes == least + more && plan.bytes == full + more);
            }
        }
        c.stream = c.remember = 0;
        c.depth = T3R_DEPTH_STEREO;
        if (t3r_config_error(&c) == NULL) {
            assert_int_equal(t3r_plan(&c, &plan), T3R_OK);
            assert_true(plan.min_bytes == T3R_STEREO_ARENA_MIN_BYTES(c.width, c.height, c.views, c.max_gaussians));
            assert_true(plan.bytes == T3R_STEREO_ARENA_BYTES(c.width, c.height, c.views, c.max_gaussians));
        }
    }
}

/* Settings unknown to the macros must not need more. */
/* Finds the most Gaussians that fit, never more than requested; one more does not fit. */
TEST(plan_within_is_the_inverse)
{
    dice d = {11};
    uint32_t cut = 0, refused = 0;
    for (int i = 0; i < 20000; i++) {
        t3r_config c = random_config(&d, T3R_MAX_SIDE, T3R_MAX_GAUSSIANS), fitted = c;
        c.stream = c.views > 0 && c.depth == T3R_DEPTH_SENSOR && dice_below(&d, 4) == 0;
        fitted = c;
        t3r_plan_info plan, one, more;
        assert_int_equal(t3r_plan(&c, &plan), T3R_OK);
        t3r_config single = c;
        single.max_gaussians = single.gaussians = 1;
        assert_int_equal(t3r_plan(&single, &one), T3R_OK);
        /* from too little for one Gaussian to more than all need */
        const size_t bytes =
            one.min_bytes - 1 + (size_t)dice_below(&d, 1001) * (plan.min_bytes - one.min_bytes + 5) / 1000;
        const t3r_status status = t3r_plan_within(bytes, &fitted);
        if (bytes < one.min_bytes) {
            assert_int_equal(status, T3R_ERR_ARENA);
            assert_memory_equal(&fitted, &c, sizeof c);
            refused++;
            continue;
        }
        assert_int_equal(status, T3R_OK);
        assert_int_equal(t3r_plan(&fitted, &plan), T3R_OK);
        assert_true(plan.min_bytes <= bytes);
        assert_true(fitted.max_gaussians <= c.max_gaussians);
        assert_int_equal(fitted.gaussians, c.gaussians < fitted.max_gaussians ? c.gaussians : fitted.max_gaussians);
        if (fitted.max_gaussians < c.max_gaussians) {
            t3r_config next = fitted;
            next.max_gaussians++;
            assert_int_equal(t3r_plan(&next, &more), T3R_OK);
            assert_true(more.min_bytes > bytes);
            cut++;
        }
        fitted.max_gaussians = c.max_gaussians; /* and nothing else has changed */
        fitted.gaussians = c.gaussians;
        assert_memory_equal(&fitted, &c, sizeof c);
    }
    assert_true(cut > 10000 && refused > 5);
    /* the largest scene that memory can hold, and values out of range */
    t3r_config c = t3r_default_config(256, 256, 2, T3R_MAX_GAUSSIANS);
    assert_int_equal(t3r_plan_within(LEAST, &c), T3R_OK);
    assert_true(c.max_gaussians >= 13107 && c.gaussians == c.max_gaussians);
    assert_true(T3R_ARENA_MIN_BYTES(256, 256, 2, c.max_gaussians) == LEAST);
    const t3r_config good = c;
    const struct {
        uint32_t max_gaussians, gaussians, clusters;
    } bad[] = {{0, 0, 1}, {T3R_MAX_GAUSSIANS + 1, 1, 1}, {UINT32_MAX, 1, 1}, {5, 6, 1},
               {5, 0, 1}, {5, 5, T3R_MAX_CLUSTERS + 1}};
    for (size_t i = 0; i < sizeof bad / sizeof bad[0]; i++) {
        t3r_config wrong = good;
        wrong.max_gaussians = bad[i].max_gaussians;
        wrong.gaussians = bad[i].gaussians;
        wrong.clusters = bad[i].clusters;
        t3r_config left = wrong;
        assert_int_equal(t3r_plan_within(SIZE_MAX, &left), T3R_ERR_CONFIG);
        assert_memory_equal(&left, &wrong, sizeof wrong);
    }
}

TEST(plan_depends_on_sizes_alone)
{
    t3r_config c = t3r_default_config(64, 48, 2, 500);
    c.clusters = 24;
    t3r_plan_info plan, other;
    assert_int_equal(t3r_plan(&c, &plan), T3R_OK);
    c.gaussians = 7;
    c.wavelet = T3R_WAVELET_CDF53;
    c.levels = T3R_MAX_LEVELS;
    c.cluster_batches = 1024;
    c.allocate = T3R_ALLOCATE_PAPER;
    c.head = T3R_HEAD_LEARNED;
    c.fill_radius = 8;
    c.bridge_radius = 255;
    c.seed = 12345;
    assert_int_equal(t3r_plan(&c, &other), T3R_OK);
    assert_true(plan.min_bytes == other.min_bytes && plan.bytes == other.bytes);
}

static void assert_untouched(const arena *a)
{
    const uint8_t *bytes = a->bytes;
    for (size_t i = 0; i < a->count; i++) {
        assert_int_equal(bytes[i], 0xa5);
    }
}

TEST(minimum_works_one_less_is_refused)
{
    dice d = {2};
    for (int i = 0; i < 400; i++) {
        t3r_config c = random_config(&d, 64, 2000);
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&c, &plan), T3R_OK);
        arena less = arena_of_bytes(plan.min_bytes - 1), least = arena_of_bytes(plan.min_bytes);
        t3r_runtime *rt = (t3r_runtime *)(void *)&c;
        assert_int_equal(t3r_init(&rt, less.bytes, less.count, &c), T3R_ERR_ARENA);
        assert_null(rt);
        assert_untouched(&less);
        assert_int_equal(t3r_init(&rt, least.bytes, least.count, &c), T3R_OK);
        assert_non_null(rt);
        t3r_scene scene;
        assert_int_equal(t3r_get_scene(rt, &scene), T3R_ERR_STATE);
        /* a full scene, drawn at the largest size, stays inside: the arena ends at the allocation's end */
        t3r_scene_frame frame = {{0}, 0};
        t3r_gaussian g = round_gaussian(0, 0, 2, 0.3, 0.5, 1, 1, 1);
        assert_int_equal(t3r_scene_begin(rt, &frame), T3R_OK);
        for (uint32_t k = 0; k < c.max_gaussians; k++) {
            g.position_q20[0] = ((int32_t)(k % 64) - 32) * 65536;
            assert_int_equal(t3r_scene_append(rt, &g), T3R_OK);
        }
        assert_int_equal(t3r_scene_append(rt, &g), T3R_ERR_FULL);
        t3r_camera camera = plain_camera(40, c.render_width, c.render_height);
        drawing picture = draw(rt, &camera, c.render_width, c.render_height);
        assert_true(picture.passes >= 1);
        drawing_free(&picture);
        arena_free(&less);
        arena_free(&least);
    }
}

TEST(every_size_up_to_the_minimum)
{
    t3r_config configs[] = {t3r_default_config(8, 8, 1, 1), t3r_default_config(8, 8, 0, 1)};
    for (size_t k = 0; k < sizeof configs / sizeof configs[0]; k++) {
        configs[k].clusters = 1;
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&configs[k], &plan), T3R_OK);
        for (size_t bytes = 0; bytes <= plan.min_bytes; bytes += bytes < 300 || bytes + 300 > plan.min_bytes ? 1 : 61) {
            arena a = arena_of_bytes(bytes);
            t3r_runtime *rt = (t3r_runtime *)(void *)&plan;
            t3r_status expected = bytes < plan.min_bytes ? T3R_ERR_ARENA : T3R_OK;
            assert_int_equal(t3r_init(&rt, a.bytes, a.count, &configs[k]), expected);
            assert_true((rt != NULL) == (expected == T3R_OK));
            if (expected != T3R_OK) {
                assert_untouched(&a);
            }
            rt = (t3r_runtime *)(void *)&plan;
            t3r_status attached = t3r_attach(&rt, a.bytes, a.count);
            assert_true((attached == T3R_OK) == (expected == T3R_OK));
            assert_true((rt != NULL) == (attached == T3R_OK));
            arena_free(&a);
        }
    }
}

TEST(misaligned_is_refused)
{
    t3r_config c = t3r_default_config(16, 16, 1, 10);
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&c, &plan), T3R_OK);
    arena a = arena_of_bytes(plan.bytes + T3R_ARENA_ALIGN);
    for (size_t shift = 1; shift < T3R_ARENA_ALIGN; shift++) {
        t3r_runtime *rt = (t3r_runtime *)(void *)&c;
        assert_int_equal(t3r_init(&rt, (uint8_t *)a.bytes + shift, plan.bytes, &c), T3R_ERR_ARENA);
        assert_null(rt);
    }
    assert_untouched(&a);
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, a.bytes, plan.bytes, &c), T3R_OK);
    memmove((uint8_t *)a.bytes + 8, a.bytes, plan.bytes);
    assert_int_not_equal(t3r_attach(&rt, (uint8_t *)a.bytes + 8, plan.bytes), T3R_OK);
    assert_null(rt);
    arena_free(&a);
}

/* t3r_attach() accepts only the bytes of an initialised arena, without damage in a checked field or a cut. */
TEST(attach_refuses_foreign_bytes)
{
    t3r_config c = t3r_default_config(16, 16, 1, 10);
    arena a = arena_of(&c, ARENA_AT_FULL);
    t3r_runtime *rt = (t3r_runtime *)(void *)&c;
    assert_int_equal(t3r_attach(&rt, a.bytes, a.count), T3R_ERR_EPOCH);
    assert_null(rt);
    memset(a.bytes, 0, a.count);
    assert_int_equal(t3r_attach(&rt, a.bytes, a.count), T3R_ERR_EPOCH);
    assert_int_equal(t3r_init(&rt, a.bytes, a.count, &c), T3R_OK);
    assert_int_equal(t3r_attach(&rt, a.bytes, a.count), T3R_OK);
    assert_int_not_equal(t3r_attach(&rt, a.bytes, a.count - T3R_ARENA_ALIGN), T3R_OK);
    assert_null(rt);
    /* A damaged head gets some answer, without an access outside the arena. */
    arena damaged = arena_of_bytes(a.count);
    for (size_t bit = 0; bit < (size_t)T3R_HEADER_BYTES * 8; bit++) {
        memcpy(damaged.bytes, a.bytes, a.count);
        ((uint8_t *)damaged.bytes)[bit / 8] ^= (uint8_t)(1 << bit % 8);
        t3r_status status = t3r_attach(&rt, damaged.bytes, damaged.count);
        assert_true(status == T3R_OK || status == T3R_ERR_EPOCH || status == T3R_ERR_ARENA || status == T3R_ERR_CONFIG);
        assert_true((rt != NULL) == (status == T3R_OK));
    }
    arena_free(&damaged);
    arena_free(&a);
}

TEST(a_static_array_is_enough)
{
    t3r_config c = t3r_default_config(96, 96, 2, 900);
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, firmware_arena, sizeof firmware_arena, &c), T3R_OK);
    assert_int_equal(t3r_reset(rt), T3R_OK);
}
