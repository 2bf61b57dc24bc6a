/* SPDX-License-Identifier: Apache-2.0 */
/* Wide depth holes: depth lent by other views, bridged between what is known, and what other views say against it. */
#include "rgbd_frame.h"
#include "unit/rig.h"

#include "pointmap/bridge.h"
#include "pointmap/flying_pixels.h"
#include "pointmap/redundancy.h"

enum { PAIR = 2 };

static void forget(rig *s, int v, int pixel)
{
    s->depth[v][pixel] = 0;
    s->validity[v][pixel] = T3R_NO_DEPTH;
}

static void disc(rig *s, int v, int x, int y, int radius)
{
    for (int i = 0; i < PIXELS; i++) {
        int dx = i % W - x, dy = i / W - y;
        if (dx * dx + dy * dy <= radius * radius) {
            forget(s, v, i);
        }
    }
}

static uint32_t bridge_by(const t3r_pointmap_work *work, rig *s, uint32_t views, uint32_t radius)
{
    uint32_t bridged = 0;
    for (uint32_t v = 0; v < views; v++) {
        t3r_bridge_lend(s->view, views, v, 0, work);
    }
    for (uint32_t v = 0; v < views; v++) {
        t3r_bridge_view(&s->view[v], radius, work);
    }
    for (uint32_t v = 0; v < views; v++) {
        bridged += t3r_bridge_settle(s->view, views, v, 0, (1u << v) - 1, work);
    }
    return bridged;
}

static uint32_t bridge(rig *s, uint32_t views, uint32_t radius)
{
    return bridge_by(&alone, s, views, radius);
}

enum { WORKERS = 7 };

/* Runs the tasks from the last to the first, as different workers. */
static void reversed(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                     void *context)
{
    (void)user;
    for (uint32_t i = count; i-- > 0;) {
        task(context, i, i % WORKERS);
    }
}

static const t3r_hooks hooks = {.parallel_for = reversed};
static const t3r_pointmap_work shared = {{&hooks, WORKERS}, compared, ratios, &t3r_kernels_c};

static uint32_t of_kind(const rig *s, int v, uint8_t validity)
{
    uint32_t count = 0;
    for (int i = 0; i < PIXELS; i++) {
        count += s->validity[v][i] == validity;
    }
    return count;
}

/* --- one view ----------------------------------------------------------------------------------------------------- */

/* A slanted plane goes on through a hole as wide as a third of the picture: 1 / depth is straight in the picture. */
TEST(planes_go_on)
{
    for (int turn = 0; turn < 9; turn++) {
        rig *s = pair_new();
        double across = (turn % 3 - 1) * 0.0007, down = (turn / 3 - 1) * 0.0009;
        for (int i = 0; i < PIXELS; i++) {
            s->depth[0][i] = (uint16_t)lround(UNIT * 4 / (1 + across * (i % W) + down * (i / W)));
        }
        uint16_t truth[PIXELS];
        memcpy(truth, s->depth[0], sizeof truth);
        disc(s, 0, 30, 22, 12);
        uint32_t holes = of_kind(s, 0, T3R_NO_DEPTH);
        assert_true(holes > 400);
        assert_int_equal(bridge(s, 1, 40), holes);
        for (int i = 0; i < PIXELS; i++) {
            assert_true(abs(s->depth[0][i] - truth[i]) <= 1);
        }
        free(s);
    }
}

/* The definition once more, in double and from the planes as they were. */
static double expected_depth(const uint16_t *depth, const uint8_t *validity, int x, int y, int radius)
{
    static const int axis[4][2] = {{1, 0}, {0, 1}, {1, 1}, {1, -1}};
    double sum = 0, weights = 0, least = INFINITY, farther = 0;
    for (int k = 0; k < 4; k++) {
        double end[2] = {0, 0}, away[2] = {0, 0};
        for (int side = 0; side < 2; side++) {
            int sign = side == 0 ? -1 : 1;
            for (int i = radius; i >= 1; i--) { /* from afar, so that the nearest is noted last */
                int u = x + sign * i * axis[k][0], v = y + sign * i * axis[k][1];
                bool inside = u >= 0 && v >= 0 && u < W && v < H;
                if (inside && depth[v * W + u] != 0 && t3r_is_known(validity[v * W + u])) {
                    end[side] = depth[v * W + u];
                    away[side] = i;
                }
            }
        }
        if (end[0] == 0 || end[1] == 0) {
            continue;
        }
        double length = (away[0] + away[1]) * hypot(axis[k][0], axis[k][1]);
        double near = fmin(end[0], end[1]), deep = fmax(end[0], end[1]);
        if (deep - near <= near / 8) {
            double inverse = (away[1] / end[0] + away[0] / end[1]) / (away[0] + away[1]);
            sum += inverse / (length * length);
            weights += 1 / (length * length);
        }
        if (length < least - 1e-9) {
            least = length;
            farther = deep;
        }
    }
    return weights > 0 ? weights / sum : farther;
}

TEST(as_defined)
{
    uint64_t seed = 5;
    rig *s = unit_array(1, sizeof *s), *before = unit_array(1, sizeof *before);
    uint32_t bridged = 0;
    for (int turn = 0; turn < 60; turn++) {
        place_view(s, 0, 0, 0, 2);
        int64_t share = unit_between(&seed, 2, 40), spread = turn % 3 == 0 ? 65534 : 200;
        int64_t base = unit_between(&seed, 1, 65535 - spread);
        for (int i = 0; i < PIXELS; i++) {
            forget(s, 0, i);
            if (unit_between(&seed, 0, share) == 0) {
                s->depth[0][i] = (uint16_t)(base + unit_between(&seed, 0, spread));
                s->validity[0][i] = unit_random(&seed) % 4 == 0 ? T3R_FILLED : T3R_MEASURED;
            }
        }
        *before = *s;
        int radius = (int)unit_between(&seed, 0, 80);
        uint32_t told = bridge_by(turn % 2 == 0 ? &alone : &shared, s, 1, (uint32_t)radius);
        for (int i = 0; i < PIXELS; i++) {
            if (before->validity[0][i] != T3R_NO_DEPTH) {
                assert_int_equal(s->validity[0][i], before->validity[0][i]);
                assert_int_equal(s->depth[0][i], before->depth[0][i]);
                continue;
            }
            double expected = expected_depth(before->depth[0], before->validity[0], i % W, i / W, radius);
            assert_int_equal(s->validity[0][i], expected > 0 ? T3R_BRIDGED : T3R_NO_DEPTH);
            assert_true(fabs(s->depth[0][i] - expected) <= 0.5 + 1e-4 * expected);
            told -= expected > 0;
            bridged += expected > 0;
        }
        assert_int_equal(told, 0);
    }
    assert_true(bridged > 10000);
    free(before);
    free(s);
}

/* Across an edge no depth is invented, and the farther surface goes on behind the nearer. */
TEST(edges)
{
    rig *s = pair_new();
    for (int i = 0; i < PIXELS; i++) {
        forget(s, 0, i);
        if (i / W == 20 && (i % W == 10 || i % W == 40)) {
            s->depth[0][i] = i % W == 10 ? 1000 : 3000;
            s->validity[0][i] = T3R_MEASURED;
        }
    }
    assert_int_equal(bridge(s, 1, 28), 27); /* the pixels next to either end are 29 from the other */
    for (int x = 0; x < W; x++) {
        assert_int_equal(s->depth[0][20 * W + x], x == 10 ? 1000 : (x >= 12 && x <= 38) || x == 40 ? 3000 : 0);
    }
    free(s);
}

/* An area that is unmeasured up to the border stays unknown, except for corners that diagonals cut. */
TEST(borders_stay)
{
    rig *s = pair_new();
    for (int i = 0; i < PIXELS; i++) {
        if (i % W < 20 || i / W < 12) {
            forget(s, 0, i);
        }
    }
    assert_int_equal(bridge(s, 1, 64), 0);
    free(s);
}

/* A copied arena's planes may hold anything: what is said to be measured at depth 0 is no known pixel. */
TEST(nothing_is_trusted)
{
    uint64_t seed = 17;
    rig *s = pair_new();
    for (int turn = 0; turn < 20; turn++) {
        for (int v = 0; v < PAIR; v++) {
            for (int i = 0; i < PIXELS; i++) {
                s->validity[v][i] = unit_random(&seed) % 3 == 0 ? (uint8_t)unit_random(&seed)
                                                                : (uint8_t)(T3R_MEASURED * (unit_random(&seed) & 1));
                s->depth[v][i] = unit_random(&seed) % 2 == 0 ? 0 : (uint16_t)unit_random(&seed);
            }
        }
        (void)bridge(s, PAIR, 9);
    }
    for (int i = 0; i < PIXELS; i++) {
        s->validity[0][i] = i % 5 == 0 ? T3R_MEASURED : T3R_NO_DEPTH;
        s->depth[0][i] = 0;
    }
    assert_int_equal(bridge(s, 1, 20), 0);
    free(s);
}

/* --- two views ---------------------------------------------------------------------------------------------------- */

/* Depth from the other view is exact, in steps of this view, and small budgets take it last. */
TEST(lent)
{
    const uint64_t unit[] = {UNIT_Q40, UNIT_Q40 / 7, 3 * UNIT_Q40, UNIT_Q40 >> 4};
    for (int turn = 0; turn < 3; turn++) {
        rig *s = unit_array(1, sizeof *s);
        place_view_in_steps(s, 0, 0, 0, 2, unit[turn]);
        place_view(s, 1, 0.25, 0, 2);
        uint16_t depth = s->depth[0][0];
        disc(s, 0, 40, 24, 15);
        uint32_t holes = of_kind(s, 0, T3R_NO_DEPTH);
        assert_int_equal(bridge(s, PAIR, turn == 0 ? 0 : 30), 0);
        assert_int_equal(of_kind(s, 0, T3R_BRIDGED | T3R_MARK_COVERED), holes);
        for (int i = 0; i < PIXELS; i++) {
            assert_true(s->depth[0][i] == depth || (s->depth[0][i] == depth + 1 && turn != 0));
        }
        assert_int_equal(of_kind(s, 1, T3R_MEASURED), PIXELS);
        free(s);
    }
}

/* If two points of the other view fall on one pixel, the nearer one gives the depth. */
TEST(nearest_lent)
{
    rig *s = pair_new();
    forget(s, 0, 20 * W + 40); /* the plane's point from 8 pixels to the left, one at 1 from 16 */
    s->depth[1][20 * W + 24] = UNIT;
    t3r_bridge_lend(s->view, PAIR, 0, 0, &alone);
    assert_int_equal(s->validity[0][20 * W + 40], T3R_BRIDGED | T3R_MARK_LENT);
    assert_int_equal(s->depth[0][20 * W + 40], UNIT);
    free(s);
}

/* Nothing is lent that is farther than the view's own steps reach. */
TEST(out_of_steps_is_not_lent)
{
    rig *s = unit_array(1, sizeof *s);
    place_view_in_steps(s, 0, 0, 0, 2, UNIT_Q40 >> 5); /* 65,535 steps are 2 - 1/32768 */
    place_view(s, 1, 0.25, 0, 2);
    for (int i = 0; i < PIXELS; i++) {
        forget(s, 0, i);
    }
    t3r_bridge_lend(s->view, PAIR, 0, 0, &alone);
    assert_int_equal(of_kind(s, 0, T3R_NO_DEPTH), PIXELS);
    s->depth[1][20 * W + 24] = 3 * UNIT / 2; /* by 10.7 pixels to the right */
    t3r_bridge_lend(s->view, PAIR, 0, 0, &alone);
    assert_int_equal(of_kind(s, 0, T3R_BRIDGED | T3R_MARK_LENT), 1);
    assert_int_equal(s->depth[0][20 * W + 35], 3 * UNIT / 2 * 32);
    free(s);
}

/* A view whose first step is beyond the scene takes that step for any depth. */
TEST(steps_longer_than_the_scene)
{
    enum { EXPONENT = -5, STEPS = 2 * UNIT >> -EXPONENT }; /* a wall two scene units away */
    rig *s = pair_new();
    s->view[0].depth_unit_q40 = UINT64_C(1) << 46;
    for (int i = 0; i < PIXELS; i++) {
        forget(s, 0, i);
        s->depth[1][i] = STEPS;
    }
    t3r_bridge_lend(s->view, PAIR, 0, EXPONENT, &alone);
    assert_true(of_kind(s, 0, T3R_BRIDGED | T3R_MARK_LENT) > PIXELS / 2);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(s->depth[0][i], s->validity[0][i] != T3R_NO_DEPTH);
    }
    free(s);
}

/* A surface that neither view measured is bridged in the first and covered in the second. */
TEST(bridged_once)
{
    rig *s = pair_new();
    disc(s, 0, 40, 24, 10);
    disc(s, 1, 32, 24, 10); /* the same place */
    uint32_t holes = of_kind(s, 0, T3R_NO_DEPTH);
    assert_int_equal(bridge(s, PAIR, 30), holes);
    assert_int_equal(of_kind(s, 0, T3R_BRIDGED), holes);
    assert_int_equal(of_kind(s, 1, T3R_BRIDGED | T3R_MARK_COVERED), holes);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(s->depth[0][i], 2 * UNIT);
        assert_int_equal(s->depth[1][i], 2 * UNIT);
    }
    free(s);
}

/* Nothing is left before what another view measured: 16 times the distance between them above the depth. */
TEST(seen_through)
{
    for (int steps = UNIT; steps <= 3 * UNIT; steps += 7) {
        rig *s = pair_new();
        place_view(s, 2, 0.25, 0, 2); /* says the same as the second view */
        int at = 24 * W + 45, there = at - (int)lround(0.25 * F * UNIT / steps);
        s->depth[0][at] = (uint16_t)steps;
        s->validity[0][at] = T3R_BRIDGED;
        int behind = steps - s->depth[1][there];
        bool before = 16 * -behind > steps, same = 16 * abs(behind) <= steps;
        assert_int_equal(t3r_bridge_settle(s->view, VIEWS, 0, 0, 0, &alone), !before && !same);
        assert_int_equal(s->validity[0][at], before ? T3R_NO_DEPTH
                                             : same ? T3R_BRIDGED | T3R_MARK_COVERED
                                                    : T3R_BRIDGED);
        assert_int_equal(s->depth[0][at], before ? 0 : steps);
        free(s);
    }
}

/* If both views bridge one surface, the later bridge is covered by the earlier one, in either order of the views. */
TEST(settled_cover)
{
    for (uint32_t v = 0; v < PAIR; v++) {
        rig *s = pair_new();
        int at[PAIR] = {24 * W + 45, 24 * W + 45 - (int)lround(0.25 * F)};
        for (int w = 0; w < PAIR; w++) {
            s->depth[w][at[w]] = UNIT;
            s->validity[w][at[w]] = T3R_BRIDGED;
        }
        assert_int_equal(t3r_bridge_settle(s->view, PAIR, v, 0, 0, &alone), 1);
        assert_int_equal(t3r_bridge_settle(s->view, PAIR, v, 0, 1u << (1 - v), &alone), 0);
        assert_int_equal(s->validity[v][at[v]], T3R_BRIDGED | T3R_MARK_COVERED);
        assert_int_equal(s->validity[1 - v][at[1 - v]], T3R_BRIDGED);
        free(s);
    }
}

/* Later comparisons leave such pixels as they are, and forgetting them gives back the planes as they were. */
TEST(forgotten)
{
    rig *s = pair_new(), *before = unit_array(1, sizeof *before);
    disc(s, 0, 40, 24, 12);
    disc(s, 1, 20, 24, 12);
    disc(s, 1, 40, 20, 9);
    s->depth[1][5 * W + 5] = UNIT;
    memcpy(before->depth, s->depth, sizeof s->depth);
    memcpy(before->validity, s->validity, sizeof s->validity);
    (void)bridge(s, PAIR, 30);
    uint32_t bridged = of_kind(s, 0, T3R_BRIDGED), covered = of_kind(s, 0, T3R_BRIDGED | T3R_MARK_COVERED);
    assert_true(bridged > 0 && covered > 0);
    for (uint32_t v = PAIR; v-- > 0;) {
        (void)t3r_mark_flying(s->view, PAIR, v, 0, false, &alone);
    }
    for (uint32_t v = PAIR; v-- > 0;) {
        (void)t3r_mark_covered(s->view, PAIR, v, 0, &alone);
    }
    t3r_clear_witnesses(s->view, PAIR);
    assert_int_equal(of_kind(s, 0, T3R_BRIDGED), bridged);
    assert_int_equal(of_kind(s, 0, T3R_BRIDGED | T3R_MARK_COVERED), covered);
    assert_int_equal(s->validity[1][5 * W + 5], T3R_MEASURED | T3R_MARK_DOUBTFUL);
    t3r_reset_comparison(s->view, PAIR);
    assert_memory_equal(s->depth, before->depth, sizeof s->depth);
    assert_memory_equal(s->validity, before->validity, sizeof s->validity);
    free(before);
    free(s);
}

/* --- through the interface ---------------------------------------------------------------------------------------- */

/* Adds views of a wall with a round hole in depth, or one at the left border; returns how many pixels are measured. */
static uint32_t add_walls(t3r_runtime *rt, uint32_t views, bool border)
{
    static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];
    uint32_t measured = 0;
    uint64_t seed = 3;
    for (uint32_t v = 0; v < views; v++) {
        for (int i = 0; i < PIXELS; i++) {
            int dx = i % W - (v == 0 ? 40 : 32), dy = i / W - 24;
            uint32_t steps = (border ? i % W < 8 : dx * dx + dy * dy <= 100) ? 0 : 2 * UNIT;
            measured += steps != 0;
            depth[2 * i] = (uint8_t)steps;
            depth[2 * i + 1] = (uint8_t)(steps >> 8);
            for (int c = 0; c < 3; c++) {
                rgb[3 * i + c] = (uint8_t)unit_between(&seed, 60, 180);
            }
        }
        memset(rgb, 0, border ? 3 * W : 0); /* a black row */
        t3r_frame frame = rgbd_frame(rgb, depth, W, H, UNIT_Q40);
        t3r_camera camera = {.fx_q16 = F << 16,
                             .fy_q16 = F << 16,
                             .cx_q16 = (W / 2) << 16,
                             .cy_q16 = (H / 2) << 16,
                             .position_q32 = {(int64_t)v << 30},
                             .rotation_q30 = {1 << 30}};
        assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
    }
    return measured;
}

static t3r_config config_of(uint32_t radius)
{
    t3r_config config = t3r_default_config(W, H, 2, 2 * PIXELS);
    config.clusters = 20;
    config.bridge_radius = radius;
    return config;
}

static void *open_with(const t3r_config *config, t3r_runtime **rt)
{
    t3r_plan_info plan;
    assert_int_equal(t3r_plan(config, &plan), T3R_OK);
    void *arena = aligned_alloc(T3R_ARENA_ALIGN, (plan.bytes + 63) / 64 * 64);
    assert_non_null(arena);
    assert_int_equal(t3r_init(rt, arena, plan.bytes, config), T3R_OK);
    return arena;
}

static uint32_t reconstruct(uint32_t radius, uint32_t gaussians, uint32_t views, t3r_scene *scene, t3r_gaussian *out)
{
    t3r_config config = config_of(radius);
    config.gaussians = gaussians;
    t3r_runtime *rt;
    void *arena = open_with(&config, &rt);
    const uint32_t measured = add_walls(rt, views, false);
    assert_int_equal(t3r_reconstruct(rt, NULL, scene), T3R_OK);
    memcpy(out, scene->gaussians, scene->count * sizeof *out);
    free(arena);
    return measured;
}

/* A hole at the border that nothing brackets is guessed where it shows something, unless the setting is off or nothing
 * is bridged. The points add nothing to the budget. */
TEST(guessed)
{
    for (uint32_t turn = 0; turn < 3; turn++) {
        t3r_config config = config_of(turn == 1 ? 0 : 64);
        config.guess = turn != 2;
        t3r_runtime *rt;
        t3r_scene scene;
        t3r_view views[T3R_MAX_VIEWS];
        void *arena = open_with(&config, &rt);
        const uint32_t measured = add_walls(rt, 1, true);
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        assert_int_equal(scene.valid_points, measured);
        t3r_views_of(rt, views);
        for (uint32_t i = 0; i < PIXELS; i++) {
            const bool hole = i % W < 8, guess = hole && i >= W && turn == 0;
            assert_int_equal(views[0].depth[i], hole && !guess ? 0 : 2 * UNIT);
            assert_int_equal(t3r_is_bridged(views[0].validity[i]), guess);
        }
        free(arena);
    }
}

/* Bridged points compete but add nothing to the budget: exactly Z, and at most what was measured. */
TEST(budgets_hold)
{
    static t3r_gaussian out[2 * PIXELS];
    for (uint32_t views = 1; views <= 2; views++) {
        for (uint32_t radius = 0; radius <= 64; radius += 64) {
            const uint32_t budgets[] = {200, 2000, 2 * PIXELS};
            for (int b = 0; b < 3; b++) {
                t3r_scene scene;
                uint32_t measured = reconstruct(radius, budgets[b], views, &scene, out), bridged = 0;
                assert_int_equal(scene.valid_points, measured);
                assert_int_equal(scene.count, budgets[b] < measured ? budgets[b] : measured);
                for (uint32_t i = 0; i < scene.count; i++) {
                    bridged += out[i].confidence == t3r_confidence_of(T3R_BRIDGED);
                }
                assert_true(radius == 0 ? bridged == 0 : bridged > 0);
            }
        }
    }
}
