/* SPDX-License-Identifier: Apache-2.0 */
/* Remembered keyframes without planes: colours in five bits that keep their mean, the choice by the map's need, and a
 * map that keeps showing them. */
#include "unit/unit.h"

#include "rgbd_frame.h"
#include "state/remembered.h"
#include "stream/remember.h"

enum { SIDE = 32, PIXELS = SIDE * SIDE, BUDGET = 300 };

static _Alignas(T3R_ARENA_ALIGN) uint8_t arena[1 << 20];
static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];

static t3r_config stream_config(uint32_t remember)
{
    t3r_config c = t3r_default_config(SIDE, SIDE, 1, BUDGET);
    c.stream = 1;
    c.refine = 2;
    c.remember = remember;
    c.gate = c.exposure = c.fill_radius = c.bridge_radius = 0;
    return c;
}

static t3r_runtime *begin(const t3r_config *config)
{
    t3r_runtime *rt;
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    assert_true(plan.bytes <= sizeof arena);
    assert_int_equal(t3r_init(&rt, arena, plan.bytes, config), T3R_OK);
    return rt;
}

/* Takes a keyframe of a grey wall two metres in front of a camera at x, z metres. The leftmost column has no depth. */
static t3r_status try_to_take(t3r_runtime *rt, double x, double z, uint8_t level)
{
    const uint32_t mm = (uint32_t)((2 - z) * 1000);
    for (uint32_t i = 0; i < PIXELS; i++) {
        memset(rgb + 3 * i, level, 3);
        depth[2 * i] = (uint8_t)(i % SIDE == 0 ? 0 : mm);
        depth[2 * i + 1] = (uint8_t)(i % SIDE == 0 ? 0 : mm >> 8);
    }
    const t3r_frame frame = rgbd_frame(rgb, depth, SIDE, SIDE, MILLIMETRE_Q40);
    t3r_camera camera = straight_camera(SIDE);
    camera.position_q32[0] = (int64_t)(x * 4294967296.0);
    camera.position_q32[2] = (int64_t)(z * 4294967296.0);
    return t3r_stream_keyframe(rt, &frame, &camera, NULL);
}

static void take(t3r_runtime *rt, double x, double z, uint8_t level)
{
    assert_int_equal(try_to_take(rt, x, z, level), T3R_OK);
}

TEST(five_bits_keep_the_mean)
{
    const uint8_t levels[] = {0, 1, 3, 77, 128, 200, 254, 255};
    const t3r_config config = stream_config(1);
    for (size_t l = 0; l < sizeof levels; l++) {
        t3r_runtime *rt = begin(&config);
        take(rt, 0, 0, levels[l]);
        assert_int_equal(rt->remembered, 0);
        take(rt, 50, 0, 9);
        assert_int_equal(rt->remembered, 1);
        const uint16_t *pixels = t3r_remembered_pixels(t3r_remembered_at(rt, 0));
        for (int c = 0; c < 3; c++) {
            uint32_t sum_q7 = 0;
            for (uint32_t i = 0; i < PIXELS; i++) {
                const uint32_t q7 = t3r_remembered_q7(pixels[i], c);
                assert_true(abs((int)q7 - levels[l] * 128) <= 9 * 128);
                assert_int_equal(t3r_is_remembered(pixels[i]), i % SIDE != 0);
                sum_q7 += q7;
            }
            assert_true(abs((int)(sum_q7 / PIXELS) - levels[l] * 128) <= 40); /* a third of a level */
        }
    }
}

static uint32_t numbers_of(const t3r_runtime *rt)
{
    uint32_t bits = 0;
    for (uint32_t k = 0; k < rt->remembered; k++) {
        bits |= 1u << t3r_remembered_at(rt, k)->number;
    }
    return bits;
}

/* The keyframe to be forgotten is one of several of one place, never the only one of another place. */
TEST(forgets_what_is_shown_often)
{
    const t3r_config config = stream_config(3);
    t3r_runtime *rt = begin(&config);
    take(rt, 0, 0, 90);
    for (int i = 0; i < 3; i++) {
        take(rt, 50, 0, 90);
    }
    assert_int_equal(numbers_of(rt), 1 << 1 | 1 << 2 | 1 << 3);
    take(rt, 50, 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 1 | 1 << 2 | 1 << 4);
    take(rt, 50, 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 1 | 1 << 4 | 1 << 5);
    t3r_reset(rt);
    assert_int_equal(rt->remembered, 0);
}

/* A stationary camera remembers keyframes spread over its time. */
TEST(spreads_over_time)
{
    const t3r_config config = stream_config(3);
    t3r_runtime *rt = begin(&config);
    for (int i = 0; i < 20; i++) {
        take(rt, 0, 0, 90);
    }
    assert_int_equal(numbers_of(rt), 1 << 8 | 1 << 16 | 1 << 19); /* the last is the newest without planes */
}

static uint32_t mean_level(const t3r_runtime *rt)
{
    t3r_scene scene;
    assert_int_equal(t3r_get_scene(rt, &scene), T3R_OK);
    uint64_t sum_q7 = 0;
    for (uint32_t i = 0; i < scene.count; i++) {
        sum_q7 += scene.gaussians[i].colour_q7[0];
    }
    return (uint32_t)(sum_q7 / scene.count / 128);
}

/* The wall turns darker after a long time: the map follows, but not completely. */
TEST(the_map_remembers)
{
    uint32_t level[2];
    for (uint32_t i = 0; i < 2; i++) {
        const t3r_config config = stream_config(3 * i);
        t3r_runtime *rt = begin(&config);
        for (int k = 0; k < 4; k++) {
            take(rt, 0, 0, 200);
        }
        take(rt, 0, 0, 120);
        take(rt, 0, 0, 120);
        level[i] = mean_level(rt);
    }
    assert_true(level[0] < 150);
    assert_true(level[1] > level[0] + 20 && level[1] < 197);
}

/* From afar alone a Gaussian does not change, unless a remembered keyframe shows it closely. */
TEST(holds_what_it_shows)
{
    for (uint32_t remember = 0; remember < 2; remember++) {
        const t3r_config config = stream_config(remember);
        t3r_runtime *rt = begin(&config);
        take(rt, 0, 0, 90);
        const t3r_map_record *record = &t3r_map_of(rt).records[rt->gaussians / 2];
        take(rt, 0, -2, 90);
        assert_int_equal(record->idle, remember ? 0 : 1);
        assert_int_equal(record->fitted, 0);
    }
}

/* A remembered keyframe shows nothing where it had no depth. The second one is eight columns to the right of the
 * first: one column of the first one's Gaussians falls on its column without depth, and some miss it. */
TEST(hides_what_had_no_depth)
{
    const t3r_config config = stream_config(1);
    t3r_runtime *rt = begin(&config);
    take(rt, -0.5, 0, 90);
    const int32_t near_q8 = t3r_map_of(rt).records[0].grain_q8;
    take(rt, 0, 0, 90);
    take(rt, 0, -2, 90);
    const t3r_map map = t3r_map_of(rt);
    const double unit = ldexp(1, rt->frame.exponent - 20);
    uint32_t held = 0, hidden = 0;
    for (uint32_t i = 0; i < map.count; i++) {
        const int32_t *at = map.gaussians[i].position_q20;
        const double column = (at[0] * unit - 0.5) / (at[2] * unit) * SIDE + SIDE / 2.0;
        const bool near_an_edge = fabs(column - floor(column) - 0.5) < 0.1;
        if (map.records[i].grain_q8 == near_q8 && !near_an_edge) {
            assert_int_equal(map.records[i].idle, column < 0.5);
            held += column >= 0.5;
            hidden += column > -0.5 && column < 0.5;
        }
    }
    assert_true(held > 50 && hidden > 2);
}

/* A keyframe that saw everything from afar protects nothing that was seen closely. */
TEST(holds_nothing_from_afar)
{
    const t3r_config config = stream_config(1);
    t3r_runtime *rt = begin(&config);
    take(rt, 0, 0, 90);
    take(rt, 0, -2, 90);
    const t3r_map_record *record = &t3r_map_of(rt).records[rt->gaussians / 2];
    assert_int_equal(record->idle, 0);
    take(rt, 0, -2, 90); /* the distant one replaces the near one */
    assert_int_equal(record->idle, 1);
}

static double units(const t3r_runtime *rt, int count)
{
    return ldexp(count, rt->frame.exponent);
}

/* The map's range is 1,024 units around an origin that follows the camera. A keyframe beyond it neither protects nor
 * refines, and is forgotten first, for any numbers. */
TEST(forgets_first_what_is_out_of_range)
{
    const t3r_config config = stream_config(2);
    t3r_runtime *rt = begin(&config);
    take(rt, 0, 0, 90);
    take(rt, 0, 0, 90);
    take(rt, units(rt, 700), 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 1 | 1 << 2);
    take(rt, units(rt, 1400), 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 3 | 1 << 2);
    take(rt, units(rt, 1400), 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 3 | 1 << 4);
}

/* The keyframe that loses its planes can itself be out of range. It shows nothing of the map. */
TEST(remembers_what_is_out_of_range)
{
    const t3r_config config = stream_config(2);
    t3r_runtime *rt = begin(&config);
    take(rt, 0, 0, 90);
    take(rt, 0, 0, 90);
    take(rt, -units(rt, 500), 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 1 | 1 << 2);
    take(rt, units(rt, 900), 0, 90); /* 1,400 units from the previous one */
    assert_int_equal(numbers_of(rt), 1 << 3 | 1 << 2);
}

/* A live keyframe that went out of range lost its depth, and is not remembered. */
TEST(remembers_only_what_shows_something)
{
    t3r_config config = stream_config(2);
    config.views = 3;
    t3r_runtime *rt = begin(&config);
    take(rt, 0, 0, 90);
    take(rt, units(rt, 900), 0, 90);
    take(rt, units(rt, 1800), 0, 90);
    take(rt, units(rt, 1800), 0, 90);
    assert_int_equal(rt->remembered, 0);
    take(rt, units(rt, 1800), 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 2);
}

/* Memory may come back changed: an invalid camera shows nothing, and is forgotten first. */
TEST(passes_over_cameras_that_are_none)
{
    const t3r_config config = stream_config(3);
    t3r_runtime *rt = begin(&config);
    for (int i = 0; i < 3; i++) {
        take(rt, 0, 0, 90);
    }
    t3r_remembered_at(rt, 1)->camera.fx_q16 = 0;
    take(rt, 0, 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 1 | 1 << 2 | 1 << 3);
    take(rt, 0, 0, 90);
    assert_int_equal(numbers_of(rt), 1 << 1 | 1 << 4 | 1 << 3);
}

typedef struct steps {
    uint32_t calls, cancel_at; /* 0 = never */
} steps;

static int progress(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    steps *s = user;
    assert_true(stage < T3R_STAGE_COUNT && done <= total);
    return ++s->calls == s->cancel_at;
}

/* A keyframe is also cancelled while remembered ones refine the map. */
TEST(is_cancelled_at_every_step)
{
    uint32_t calls = 1;
    for (uint32_t at = 0; at <= calls; at++) {
        const t3r_config config = stream_config(1);
        t3r_runtime *rt = begin(&config);
        take(rt, 0, 0, 90);
        steps s = {0, at};
        const t3r_hooks hooks = {.user = &s, .progress = progress};
        assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
        assert_int_equal(try_to_take(rt, 0, 0, 90), at == 0 ? T3R_OK : T3R_ERR_CANCELLED);
        calls = at == 0 ? s.calls : calls;
        assert_int_equal(s.calls, at == 0 ? calls : at);
    }
    assert_true(calls > 12); /* before and in each of two keyframes, in two passes, and before each stage */
}

/* More keyframes than there is room for cannot be a state of the library. */
TEST(refuses_more_than_fit)
{
    const t3r_config config = stream_config(1);
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
    t3r_runtime *rt = begin(&config);
    take(rt, 0, 0, 90);
    take(rt, 0, 0, 90);
    assert_int_equal(t3r_attach(&rt, arena, plan.bytes), T3R_OK);
    rt->remembered = 2;
    assert_int_equal(t3r_attach(&rt, arena, plan.bytes), T3R_ERR_EPOCH);
}
