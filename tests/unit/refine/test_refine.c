/* SPDX-License-Identifier: Apache-2.0 */
/* Refinement on the built-in room: it reaches its documented gain, changes nothing without residuals, can be cancelled
 * anywhere, and its bits depend neither on the arena's size nor on the order of parallel work. */
#include "rgbd_frame.h"
#include "sanitized_cpu.h"
#include "unit/unit.h"

#include "core/fixed.h"
#include "core/hash.h"
#include "refine/refine.h"
#include "room/room.h"
#include "state/state.h"

enum { SIDE = 96, POINTS = 2 * SIDE * SIDE, BUDGET = POINTS / 10 };

static uint8_t rgb[2][SIDE * SIDE * 3], depth[2][SIDE * SIDE * 2];
static t3r_camera camera[2];
static void *memory;
static size_t memory_bytes;

static t3r_correction solve(const t3r_refine_sums *sums, const t3r_correction *before)
{
    t3r_correction c = *before;
    t3r_solve_c(sums, 1, &c);
    return c;
}

typedef struct counter {
    uint32_t calls, cancel_at; /* 0 = never */
    uint32_t views, last;      /* number of refined views in all passes; the last one, from 1 on */
} counter;

static int count_refine(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    counter *c = user;
    assert_true(done <= total);
    if (stage != T3R_STAGE_REFINE) {
        return 0;
    }
    c->views += done + 1 != c->last;
    c->last = done + 1;
    return ++c->calls == c->cancel_at;
}

static void reversed(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                     void *context)
{
    (void)user;
    while (count > 0) {
        task(context, --count, 0);
    }
}

static int draw_room(void **state)
{
    (void)state;
    static uint16_t depth_mm[SIDE * SIDE];
    for (uint32_t v = 0; v < 2; v++) {
        room_camera(2 * v, SIDE, SIDE, &camera[v]);
        room_frame(2 * v, SIDE, SIDE, 1, rgb[v], depth_mm);
        for (uint32_t i = 0; i < SIDE * SIDE; i++) {
            depth[v][2 * i] = (uint8_t)depth_mm[i];
            depth[v][2 * i + 1] = (uint8_t)(depth_mm[i] >> 8);
        }
    }
    return 0;
}

static t3r_config settings(uint32_t refine)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, 2, BUDGET);
    config.refine = refine;
    config.fit_passes = config.fit_widths = config.rim = 0;
    config.clusters = 64;
    return config;
}

/* Opens an arena of the minimum plus `share` sixteenths of the difference to full speed. */
static t3r_runtime *open_arena(const t3r_config *config, uint32_t share)
{
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    memory_bytes = plan.min_bytes + (plan.bytes - plan.min_bytes) * share / 16;
    assert_int_equal(posix_memalign(&memory, T3R_ARENA_ALIGN, memory_bytes), 0);
    t3r_runtime *rt;
    assert_int_equal(t3r_init(&rt, memory, memory_bytes, config), T3R_OK);
    vectors_if_sanitized(rt);
    for (uint32_t v = 0; v < config->views; v++) {
        t3r_frame frame = rgbd_frame(rgb[v], depth[v], SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
        assert_int_equal(t3r_add_view(rt, &frame, &camera[v]), T3R_OK);
    }
    return rt;
}

static uint64_t hash_of(const t3r_scene *scene)
{
    return t3r_hash_bytes(T3R_HASH_START, (const uint8_t *)scene->gaussians, scene->count * sizeof *scene->gaussians);
}

static double context_psnr(t3r_runtime *rt)
{
    static uint8_t drawn[SIDE * SIDE * 3];
    t3r_target target = {.width = SIDE, .height = SIDE, .rgb = drawn, .rgb_stride_bytes = 3 * SIDE};
    double sum = 0;
    for (uint32_t v = 0; v < 2; v++) {
        assert_int_equal(t3r_render(rt, &camera[v], &target), T3R_OK);
        for (uint32_t i = 0; i < sizeof drawn; i++) {
            double d = (double)drawn[i] - rgb[v][i];
            sum += d * d;
        }
    }
    return 10 * log10(255.0 * 255.0 * 2 * sizeof drawn / sum);
}

static double refined_psnr(uint32_t refine, uint32_t gaussians)
{
    t3r_config config = settings(refine);
    config.gaussians = config.max_gaussians = gaussians;
    config.flying = config.redundancy = config.exposure = 0; /* measured against the original pictures */
    t3r_runtime *rt = open_arena(&config, 16);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    double db = context_psnr(rt);
    free(memory);
    return db;
}

TEST(gains_what_it_promises)
{
    static const double least[3] = {2.2, 3.3, 4.5}; /* dB gained by 1, 2 and 4 passes */
    const double plain = refined_psnr(0, BUDGET);
    for (uint32_t k = 0; k < 3; k++) {
        const double gain = refined_psnr(1u << k, BUDGET) - plain;
        print_message("%u passes: %.2f dB and %.2f\n", 1u << k, plain, gain);
        assert_true(gain >= least[k]);
    }
}

/* Makes two equal views, their depth up to 3 % off: splats of both overlap, and react to every residual together. */
static void see_it_twice(void)
{
    uint64_t seed = 7;
    camera[1] = camera[0];
    memcpy(rgb[1], rgb[0], sizeof rgb[0]);
    for (uint32_t i = 0; i < SIDE * SIDE; i++) {
        const uint32_t true_mm = depth[0][2 * i] | (uint32_t)depth[0][2 * i + 1] << 8;
        for (uint32_t v = 0; v < 2; v++) {
            uint32_t mm = true_mm * (uint32_t)unit_between(&seed, 970, 1030) / 1000;
            depth[v][2 * i] = (uint8_t)mm;
            depth[v][2 * i + 1] = (uint8_t)(mm >> 8);
        }
    }
}

TEST_WITH(many_passes_go_on, NULL, draw_room)
{
    see_it_twice();
    static const struct {
        uint32_t passes;
        double least; /* dB; with a fixed quarter of every step: 33.9, 38.8 and 42.0 */
    } promises[] = {{4, 34.7}, {8, 40.8}, {16, 45.2}};
    for (size_t i = 0; i < sizeof promises / sizeof promises[0]; i++) {
        double db = refined_psnr(promises[i].passes, POINTS * 2 / 5);
        print_message("seen twice, %u passes: %.2f dB\n", promises[i].passes, db);
        assert_true(db >= promises[i].least);
    }
}

TEST_WITH(black_stays_as_it_is, NULL, draw_room)
{
    memset(rgb, 0, sizeof rgb);
    uint64_t hash[2];
    for (uint32_t n = 0; n < 2; n++) {
        t3r_config config = settings(1 + 3 * n);
        t3r_runtime *rt = open_arena(&config, 16);
        t3r_scene scene;
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        hash[n] = hash_of(&scene);
        free(memory);
    }
    assert_true(hash[0] == hash[1]);
}

static const t3r_correction still;
static const t3r_viewpoints origin = {.count = 1};

TEST(nothing_missing_changes_nothing)
{
    uint64_t seed = 1;
    for (int i = 0; i < 1000; i++) {
        t3r_refine_sums sums = {.weight = (int32_t)unit_between(&seed, 0, 1 << 20),
                                .area = (uint32_t)unit_between(&seed, 1, 1 << 28)};
        for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
            sums.curvature[k] = (int32_t)unit_between(&seed, -INT32_MAX, INT32_MAX);
        }
        t3r_correction correction = solve(&sums, &still);
        t3r_gaussian before = {.position_q20 = {1, -2, 3 << 20},
                               .factor = {100, -7, 3, 9000, 32767, 0, -32768, 12, 1},
                               .factor_exponent = (int8_t)unit_between(&seed, -60, 15),
                               .colour_q7 = {0, 128, 32640},
                               .opacity_q15 = (uint16_t)unit_between(&seed, 0, 32767)};
        t3r_gaussian after = before;
        t3r_refine_apply(&correction, &origin, &after);
        assert_memory_equal(&before, &after, sizeof before);
    }
}

/* Sums at their bounds, of any sign: no overflow (by the sanitizers), and a valid Gaussian. */
TEST(extremes_stay_in_range)
{
    uint64_t seed = 2;
    for (int i = 0; i < 20000; i++) {
        t3r_refine_sums sums = {.area = (uint32_t)unit_between(&seed, 0, 1 << 28)};
        int32_t words[4 + T3R_REFINE_MOMENTS_2 + T3R_REFINE_MOMENTS_4];
        for (size_t k = 0; k < sizeof words / sizeof words[0]; k++) {
            words[k] = unit_random(&seed) % 3 == 0 ? (unit_random(&seed) % 2 ? INT32_MAX : -INT32_MAX)
                                                   : (int32_t)unit_between(&seed, -1000, 1000);
        }
        memcpy(&sums, words, sizeof words);
        t3r_correction c = {.step_q16 = {0}};
        for (uint32_t pass = 0; pass < 4; pass++) { /* momentum accumulates */
            c = solve(&sums, &c);
            assert_true(abs(c.step_q16[0]) <= 32767);
            assert_true(sums.weight <= 0 ? c.share_q14 == 0 : c.share_q14 >= 512 && c.share_q14 <= 8192);
            for (int k = 1; k < T3R_REFINE_PARAMETERS; k++) {
                assert_true(abs(c.step_q16[k]) <= (k < 3 ? 32767 : 6554 * 2));
            }
            for (int k = 0; k < 3; k++) {
                assert_true(abs(c.colour_q7[k]) <= 32640);
            }
        }
        t3r_gaussian g = {.factor_exponent = (int8_t)unit_between(&seed, -60, 15),
                          .opacity_q15 = (uint16_t)unit_between(&seed, 0, 32767)};
        for (int k = 0; k < 9; k++) {
            g.factor[k] = (int16_t)unit_between(&seed, -32768, 32767);
        }
        for (int k = 0; k < 3; k++) {
            g.position_q20[k] = (int32_t)unit_between(&seed, -(1 << 30), 1 << 30);
            g.colour_q7[k] = (uint16_t)unit_between(&seed, 0, 32640);
        }
        t3r_refine_apply(&c, &origin, &g);
        assert_true(g.opacity_q15 <= 32767 && g.factor_exponent >= -60 && g.factor_exponent <= 15);
        for (int k = 0; k < 3; k++) {
            assert_true(abs(g.position_q20[k]) <= 1 << 30 && g.colour_q7[k] <= 32640);
        }
    }
}

/* A long Gaussian that points to a camera comes no nearer in a pass than 7/8 of its distance. */
TEST(none_moves_through_a_camera)
{
    const t3r_viewpoints from = {.count = 2, .position_q20 = {{0, 0, -(9 << 20)}, {0, 0, 1 << 20}}};
    const t3r_correction towards = {.step_q16 = {0, -32767, 0, 0, 0, 0}};
    for (int32_t ahead = 1 << 10; ahead <= 9 << 20; ahead *= 2) {
        t3r_gaussian g = {.position_q20 = {3, -ahead / 4, (1 << 20) + ahead},
                          .factor = {0, 0, 0, 1 << 10, 0, 0, 16 << 10, 0, 0},
                          .factor_exponent = -10,
                          .opacity_q15 = 32000};
        t3r_refine_apply(&towards, &from, &g);
        const int32_t nearer = (1 << 20) + ahead - g.position_q20[2];
        assert_true(nearer > ahead / 16 && nearer <= ahead / 8);
        assert_true(16 * abs(-ahead / 4 - g.position_q20[1]) <= nearer + 16); /* along its axis */
    }
    t3r_gaussian g = {.position_q20 = {0, 0, 9 << 20}, .factor = {1 << 10}, .factor_exponent = -10};
    const t3r_correction across = {.step_q16 = {0, 6554, 0, 0, 0, 0}};
    t3r_refine_apply(&across, &from, &g);
    assert_int_equal(g.position_q20[0], 6554 << 4); /* within its reach it moves as the solution says */
}

/* Without residuals only a share of the previous pass is repeated. */
TEST(momentum_fades)
{
    t3r_refine_sums sums = {.weight = 1 << 15, .area = 1};
    t3r_correction c = {
        .colour_q7 = {32640, -32640, 100}, .step_q16 = {32767, -32767, 1600, 160, -160, 3}, .share_q14 = 1000};
    for (int i = 0; i < 3; i++) {
        t3r_correction before = c;
        c = solve(&sums, &before);
        for (int k = 0; k < 3; k++) {
            assert_int_equal(c.colour_q7[k], t3r_round_shift32(before.colour_q7[k] * 3, 4));
        }
        for (int k = 0; k < T3R_REFINE_PARAMETERS; k++) {
            assert_int_equal(c.step_q16[k], t3r_round_shift32(before.step_q16[k] * 3, 4));
        }
        assert_int_equal(c.share_q14, 1000); /* no curvature: the effect is unknown */
    }
    sums.weight = 0; /* not seen: nothing moves */
    c = solve(&sums, &c);
    assert_memory_equal(&c, &still, sizeof c);
}

/* Makes sums of a Gaussian with independent parameters, whose gradient asks for `quarters` of a step. */
static t3r_refine_sums told_of(int32_t quarters)
{
    t3r_refine_sums sums = {.weight = 1 << 15,
                            .area = 64,
                            .curvature = {80000, 0, 0, 80000, 0, 80000, [10] = 240000, [12] = 80000, [14] = 240000},
                            .gradient = {4000, 8000, -6000, 5000, 1000, 2000}};
    for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
        sums.gradient[k] = sums.gradient[k] * quarters / 4;
    }
    return sums;
}

/* The next share depends on how much of the previous step, which took 11/64 of it, is requested again: with all or
 * half of it the share doubles, its maximum; with a quarter it grows to 4/3, with none it stays; if as much is
 * requested in the other direction it halves, if three times as much or more it becomes a quarter, its minimum. */
TEST(share_follows_the_answer)
{
    static const struct {
        int32_t quarters; /* of the first request */
        int32_t share_q14;
    } cases[] = {{4, 5632}, {2, 5632}, {1, 3755}, {0, 2816}, {-4, 1408}, {-12, 704}, {-40, 704}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        t3r_refine_sums sums = told_of(4);
        t3r_correction c = solve(&sums, &still);
        assert_int_equal(c.share_q14, 2816);
        sums = told_of(cases[i].quarters);
        c = solve(&sums, &c);
        assert_in_range(c.share_q14, cases[i].share_q14 - 4, cases[i].share_q14 + 4);
    }
    static const int32_t onward[] = {2816, 5632, 8192, 8192};
    t3r_correction on = still, to_and_fro = still;
    for (int pass = 0; pass < 8; pass++) {
        t3r_refine_sums sums = told_of(4);
        on = solve(&sums, &on);
        assert_int_equal(on.share_q14, onward[T3R_MIN(pass, 3)]);
        sums = told_of(pass % 2 == 0 ? 4 : -4);
        to_and_fro = solve(&sums, &to_and_fro);
    }
    assert_int_equal(to_and_fro.share_q14, 512);
}

/* Steps at their bounds, with the largest sum on every diagonal: the quotient fits in 64 bits (by the sanitizers). */
TEST(largest_share_stays_in_range)
{
    t3r_refine_sums sums = {.weight = 1, .area = 1 << 28};
    for (int k = 0; k < T3R_REFINE_MOMENTS_4; k++) {
        sums.curvature[k] = INT32_MAX;
    }
    for (int sign = -1; sign <= 1; sign++) {
        for (int k = 0; k < T3R_REFINE_MOMENTS_2; k++) {
            sums.gradient[k] = sign * INT32_MAX;
        }
        t3r_correction before = {.step_q16 = {32767, 32767, 32767, 8066, 8066, 8066}, .share_q14 = 8192};
        t3r_correction c = solve(&sums, &before);
        assert_in_range(c.share_q14, 2048, 8192);
    }
}

/* The scale of sums keeps its bound for every area: at most 64 times one pixel's maximum. */
TEST(scale_follows_area)
{
    for (uint32_t area = 0; area <= 1u << 28; area += 1 + area / 1000) {
        uint32_t shift = t3r_refine_shift(area);
        assert_true(area <= (uint64_t)64 << shift);
        assert_true(shift == 0 || area > (uint64_t)32 << shift);
    }
}

static void arena_and_order_show(uint32_t structural)
{
    uint64_t first = 0;
    for (uint32_t share = 0; share <= 20; share += 4) {
        for (int order = 0; order < 2; order++) {
            t3r_config config = settings(2);
            config.structural = structural;
            t3r_runtime *rt = open_arena(&config, share);
            t3r_hooks hooks = {.parallel_for = order ? reversed : NULL};
            assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
            t3r_scene scene;
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
            uint64_t hash = hash_of(&scene);
            assert_true(first == 0 || hash == first);
            first = hash;
            free(memory);
        }
    }
}

TEST(arena_and_order_do_not_show)
{
    arena_and_order_show(0);
    arena_and_order_show(1);
}

TEST(cancelled_anywhere_it_can_be_done_again)
{
    for (int keep = 0; keep < 2; keep++) {
        t3r_config config = settings(2);
        config.keep_analysis = (uint32_t)keep;
        config.structural = (uint32_t)keep;
        t3r_runtime *rt = open_arena(&config, 16);
        counter c = {0};
        t3r_hooks hooks = {.user = &c, .progress = count_refine};
        assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
        t3r_scene scene;
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        uint64_t whole = hash_of(&scene);
        uint32_t calls = c.calls;
        assert_int_equal(c.views, 4);      /* two passes, two views, one slice */
        assert_true(calls >= 2 * c.views); /* before each view is listed, and before its tiles */
        for (uint32_t at = 1; at <= calls; at += at < 8 ? 1 : 7) {
            c = (counter){.cancel_at = at};
            t3r_status status = keep ? t3r_rebuild(rt, NULL, &scene) : t3r_reconstruct(rt, NULL, &scene);
            assert_int_equal(status, T3R_ERR_CANCELLED);
            assert_int_equal(t3r_get_scene(rt, &scene), T3R_ERR_STATE);
            c = (counter){0};
            status = keep ? t3r_rebuild(rt, NULL, &scene) : t3r_reconstruct(rt, NULL, &scene);
            assert_int_equal(status, T3R_OK);
            assert_true(hash_of(&scene) == whole);
        }
        free(memory);
    }
}

/* An arena moves at any time: the remains of an analysis after refinement are not used as one. */
TEST(moves_after_it)
{
    for (int keep = 0; keep < 2; keep++) {
        t3r_config config = settings(2);
        config.keep_analysis = (uint32_t)keep;
        t3r_runtime *rt = open_arena(&config, 0);
        t3r_scene scene;
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        uint64_t hash = hash_of(&scene);
        void *moved = NULL;
        assert_int_equal(posix_memalign(&moved, T3R_ARENA_ALIGN, memory_bytes), 0);
        memcpy(moved, memory, memory_bytes);
        free(memory);
        assert_int_equal(t3r_attach(&rt, moved, memory_bytes), T3R_OK);
        assert_int_equal(t3r_get_scene(rt, &scene), T3R_OK);
        assert_true(hash_of(&scene) == hash);
        assert_int_equal(t3r_rebuild(rt, NULL, &scene), keep ? T3R_OK : T3R_ERR_STATE);
        free(moved);
    }
}

/* Another budget is refined likewise: the scene equals one built with it from the start. */
TEST(rebudget_refines)
{
    uint64_t hash[2];
    for (uint32_t n = 0; n < 2; n++) {
        t3r_config config = settings(2);
        config.keep_analysis = 1;
        config.gaussians = n == 0 ? BUDGET / 2 : BUDGET;
        t3r_runtime *rt = open_arena(&config, 16);
        t3r_scene scene;
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        if (n == 1) {
            assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = BUDGET / 2}, &scene), T3R_OK);
        }
        hash[n] = hash_of(&scene);
        free(memory);
    }
    assert_true(hash[0] == hash[1]);
}

/* The number of passes is fitted: fewer for all points than for a tenth, the same scene as with exactly that number,
 * and never more than the maximum. */
TEST(fits_its_passes)
{
    uint32_t passes[2];
    for (uint32_t all = 0; all < 2; all++) {
        uint64_t hash[2];
        for (uint32_t given = 0; given < 2; given++) {
            t3r_config config = settings(given ? passes[all] : T3R_MAX_REFINE);
            config.gaussians = config.max_gaussians = all ? POINTS : BUDGET / 2;
            config.fit_passes = !given;
            t3r_runtime *rt = open_arena(&config, 16);
            assert_int_equal(t3r_refinement_passes(rt), 0);
            t3r_scene scene;
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
            passes[all] = given ? passes[all] : t3r_refinement_passes(rt);
            assert_int_equal(t3r_refinement_passes(rt), passes[all]);
            hash[given] = hash_of(&scene);
            free(memory);
        }
        assert_true(hash[0] == hash[1]);
    }
    print_message("%u passes for a twentieth, %u for all\n", passes[0], passes[1]);
    assert_true(passes[0] > passes[1] && passes[1] >= 1 && passes[0] <= T3R_MAX_REFINE);

    t3r_config config = settings(2);
    config.gaussians = config.max_gaussians = BUDGET / 20;
    config.fit_passes = 1;
    t3r_runtime *rt = open_arena(&config, 16);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_int_equal(t3r_refinement_passes(rt), 2);
    free(memory);

    /* a single view does not show its errors: 100 levels^2 are assumed */
    config = settings(T3R_MAX_REFINE);
    config.gaussians = config.max_gaussians = BUDGET / 4;
    config.fit_passes = 1;
    rt = open_arena(&config, 16);
    assert_int_equal(t3r_reset(rt), T3R_OK);
    const t3r_frame frame = rgbd_frame(rgb[0], depth[0], SIDE, SIDE, ROOM_DEPTH_UNIT_Q40);
    assert_int_equal(t3r_add_view(rt, &frame, &camera[0]), T3R_OK);
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    assert_int_equal(t3r_refinement_passes(rt), lround(sqrt(400.0 * scene.valid_points / scene.count / 100)));
    free(memory);
}

/* Makes the second view brighter and darker in turn, in squares of 16 pixels. */
static void paint_squares(int levels)
{
    for (int i = 0; i < SIDE * SIDE * 3; i++) {
        const int x = i / 3 % SIDE / 16, y = i / 3 / SIDE / 16;
        rgb[1][i] = (uint8_t)t3r_clamp32(rgb[1][i] + ((x + y) % 2 == 0 ? levels : -levels), 0, 255);
    }
}

/* Builds with fitted passes, or with exactly `given` whole ones. Returns the scene's hash, the passes and the PSNR of
 * its context views. */
static uint64_t fitted(uint32_t given, uint32_t structural, uint32_t arena, uint32_t *passes, double *psnr)
{
    t3r_config config = settings(given > 0 ? given : T3R_MAX_REFINE);
    config.structural = structural;
    config.gaussians = config.max_gaussians = BUDGET / 10;
    config.fit_passes = given == 0;
    t3r_runtime *rt = open_arena(&config, arena);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    const uint64_t hash = hash_of(&scene);
    *passes = t3r_refinement_passes(rt);
    *psnr = context_psnr(rt);
    free(memory);
    return hash;
}

/* Where neighbours share what the views disagree about, all fitted passes but the last compare a part of the pixels:
 * they are better than half as many whole ones, and the same in any arena. */
TEST(fits_passes_in_parts)
{
    paint_squares(40);
    uint32_t passes, again;
    double in_parts, whole;
    const uint64_t hash = fitted(0, 0, 16, &passes, &in_parts);
    assert_true(fitted(0, 0, 0, &again, &in_parts) == hash);
    assert_int_equal(again, passes);
    assert_true(fitted(passes, 0, 16, &again, &whole) != hash);
    assert_int_equal(again, passes);
    (void)fitted(passes / 2, 0, 16, &again, &whole);
    print_message("%u passes in parts: %.2f dB, %u whole ones: %.2f\n", passes, in_parts, again, whole);
    assert_true(passes >= 4 && in_parts > whole);
    uint32_t structural; /* this loss compares whole tiles */
    const uint64_t fitted_structural = fitted(0, 1, 16, &structural, &whole);
    assert_true(structural < passes);
    assert_true(fitted(structural, 1, 16, &again, &whole) == fitted_structural);
    assert_int_equal(draw_room(NULL), 0);
}

static uint64_t hash_with(uint32_t views, uint32_t passes, uint32_t structural)
{
    t3r_config config = settings(passes);
    config.views = views;
    config.structural = structural;
    t3r_runtime *rt = open_arena(&config, 16);
    t3r_scene scene;
    assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
    uint64_t hash = hash_of(&scene);
    free(memory);
    return hash;
}

/* A view with its own tone curve, which no gain corrects: the scene takes the middle of both, and each view without
 * its own level is matched as well as if both were equal. */
TEST_WITH(structure_passes_over_levels, NULL, draw_room)
{
    for (uint32_t views = 1; views <= 2; views++) { /* a single view has no level of its own */
        assert_true(hash_with(views, 0, 1) == hash_with(views, 0, 0));
        assert_true(hash_with(views, 4, 1) != hash_with(views, 4, 0));
    }
    static uint8_t as_it_is[2][SIDE * SIDE * 3];
    memcpy(as_it_is, rgb, sizeof as_it_is);
    double db[2][2];
    for (uint32_t structural = 0; structural < 2; structural++) {
        for (int curved = 0; curved < 2; curved++) {
            for (uint32_t i = 0; i < sizeof rgb[0]; i++) {
                rgb[0][i] = (uint8_t)(curved ? 36 + as_it_is[0][i] * 6 / 8 : 24 + as_it_is[0][i] * 6 / 8);
                rgb[1][i] = (uint8_t)(curved ? 12 + as_it_is[1][i] * 6 / 8 : 24 + as_it_is[1][i] * 6 / 8);
            }
            t3r_config config = settings(4);
            config.structural = structural;
            config.exposure = 0;
            t3r_runtime *rt = open_arena(&config, 16);
            t3r_scene scene;
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
            for (uint32_t i = 0; i < sizeof rgb[0]; i++) { /* the expected pictures */
                rgb[0][i] = (uint8_t)(24 + as_it_is[0][i] * 6 / 8);
                rgb[1][i] = (uint8_t)(24 + as_it_is[1][i] * 6 / 8);
            }
            db[structural][curved] = context_psnr(rt);
            free(memory);
        }
    }
    memcpy(rgb, as_it_is, sizeof rgb);
    print_message("views alike %.2f, one brighter %.2f dB; structural %.2f, %.2f\n", db[0][0], db[0][1], db[1][0],
                  db[1][1]);
    assert_true(db[1][0] > db[0][0] - 0.5);
    assert_true(db[1][1] > db[0][1] + 0.5);
}

ALL_TESTS_WITH(draw_room, NULL)
