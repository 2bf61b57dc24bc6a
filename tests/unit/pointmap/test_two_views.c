/* SPDX-License-Identifier: Apache-2.0 */
/* Comparisons of views of one surface: points located in another view, flying pixels, redundancy, exposure. */
#include "rgbd_frame.h"
#include "unit/rig.h"

#include "core/fixed.h"
#include "pointmap/disagreement.h"
#include "pointmap/exposure.h"
#include "pointmap/flying_pixels.h"
#include "pointmap/redundancy.h"
#include "pointmap/reproject.h"
#include "pointmap/scene_scale.h"

static uint32_t mark_covered(const rig *s, uint32_t views)
{
    uint32_t marked = 0;
    for (uint32_t v = views; v-- > 0;) {
        marked += t3r_mark_covered(s->view, views, v, 0, &alone);
    }
    t3r_clear_witnesses(s->view, views);
    return marked;
}

static void block(rig *s, int v, int x0, int y0, int x1, int y1, double depth)
{
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            s->depth[v][y * W + x] = (uint16_t)lround(depth * UNIT);
        }
    }
}

/* --- reprojection ------------------------------------------------------------------------------------------------- */

TEST(shifted_by_the_disparity)
{
    rig *s = pair_new();
    s->validity[1][5 * W + 5] = T3R_NO_DEPTH;
    t3r_pointmap zero = t3r_pointmap_of(&s->view[0], 0), one = t3r_pointmap_of(&s->view[1], 0);
    for (uint32_t y = 0; y < H; y++) {
        for (uint32_t x = 0; x < W; x++) {
            t3r_projected_pixel projected;
            bool inside = x + 8 < W && !(x == 5 && y == 5);
            assert_int_equal(t3r_reproject(&one, x, y, &zero, &projected), inside);
            if (inside) {
                assert_int_equal(projected.pixel, y * W + x + 8);
                assert_int_equal(projected.z_q20, 2 << 20);
            }
        }
    }
    /* a camera that looks the other way sees nothing of it */
    s->view[0].pose.rotation_q30[0] = s->view[0].pose.rotation_q30[8] = -(1 << 30);
    t3r_projected_pixel projected;
    assert_false(t3r_reproject(&one, 20, 20, &zero, &projected));
    free(s);
}

/* Any pose, against the same in double: the nearest pixel, but for ties that the roundings decide. */
TEST(as_in_double)
{
    uint64_t seed = 7;
    rig *s = pair_new();
    uint32_t inside = 0;
    for (int turn = 0; turn < 20000; turn++) {
        double angle = (double)unit_between(&seed, -500, 500) / 1000, c = cos(angle), sn = sin(angle);
        double rotation[9] = {c, 0, sn, 0, 1, 0, -sn, 0, c}, t[3];
        for (int i = 0; i < 9; i++) {
            s->view[0].pose.rotation_q30[i] = (int32_t)lround(rotation[i] * (1 << 30));
        }
        for (int i = 0; i < 3; i++) {
            s->view[0].pose.position_q20[i] = (int32_t)unit_between(&seed, -(1 << 20), 1 << 20);
            t[i] = s->view[0].pose.position_q20[i] / 1048576.0;
        }
        uint32_t x = (uint32_t)unit_between(&seed, 0, W - 1), y = (uint32_t)unit_between(&seed, 0, H - 1);
        s->depth[1][y * W + x] = (uint16_t)unit_between(&seed, 1, 65535);
        double z = (double)s->depth[1][y * W + x] / UNIT;
        double d[3] = {((double)x - W / 2) / F * z + 0.25 - t[0], ((double)y - H / 2) / F * z - t[1], z - t[2]}, q[3];
        for (int i = 0; i < 3; i++) {
            q[i] = rotation[i] * d[0] + rotation[3 + i] * d[1] + rotation[6 + i] * d[2];
        }
        double u = q[0] / q[2] * F + W / 2, v = q[1] / q[2] * F + H / 2;
        t3r_pointmap to = t3r_pointmap_of(&s->view[0], 0), from = t3r_pointmap_of(&s->view[1], 0);
        t3r_projected_pixel projected;
        if (t3r_reproject(&from, x, y, &to, &projected)) {
            inside++;
            assert_true(fabs(u - (double)(projected.pixel % W)) < 0.51 &&
                        fabs(v - (double)(projected.pixel / W)) < 0.51);
            assert_true(fabs(q[2] - projected.z_q20 / 1048576.0) < 1e-4);
        } else {
            assert_true(q[2] < 0.032 || u < 0 || v < 0 || u > W - 1 || v > H - 1);
        }
    }
    assert_true(inside > 2000);
    free(s);
}

/* --- flying pixels ------------------------------------------------------------------------------------------------ */

TEST(between_two_surfaces)
{
    rig *s = pair_new();
    block(s, 0, 0, 0, 20, H, 1);
    for (int y = 0; y < H; y++) {
        s->depth[0][y * W + 20] = 1400; /* between 1,024 and 2,048, on neither surface */
    }
    block(s, 0, 40, 0, W, H, 3);
    s->depth[0][9 * W + 40] = 2100; /* on the nearer one */
    uint16_t before[PIXELS];
    memcpy(before, s->depth[0], sizeof before);
    s->validity[0][7 * W + 20] = T3R_FILLED;
    assert_int_equal(t3r_mark_flying(s->view, 1, 0, 0, false, &alone), H - 1);
    for (int i = 0; i < PIXELS; i++) {
        uint8_t wanted = i == 7 * W + 20 ? T3R_FILLED : i % W == 20 ? T3R_MEASURED | T3R_MARK_DOUBTFUL : T3R_MEASURED;
        assert_int_equal(s->validity[0][i], wanted);
    }
    assert_memory_equal(before, s->depth[0], sizeof before);
    t3r_reset_comparison(s->view, 1);
    assert_int_equal(s->validity[0][8 * W + 20], T3R_MEASURED);
    assert_int_equal(s->validity[0][7 * W + 20], T3R_FILLED);
    free(s);
}

/* A surface aslant, up to 1/16 a pixel, is no depth edge. */
TEST(slanted_surfaces_stay)
{
    rig *s = pair_new();
    double depth = 0.25;
    for (int x = 0; x < W; x++, depth *= 1.06) {
        block(s, 0, x, 0, x + 1, H, depth);
    }
    assert_int_equal(t3r_mark_flying(s->view, 1, 0, 0, false, &alone), 0);
    free(s);
}

TEST(seen_through)
{
    rig *s = pair_new();
    /* at 1 the disparity is 16: a block of 6 x 6 in view 1 that view 0, 16 pixels to the right, does not see */
    block(s, 1, 20, 10, 26, 16, 1);
    s->validity[1][12 * W + 22] = T3R_FILLED;
    assert_int_equal(t3r_mark_flying(s->view, 2, 0, 0, false, &alone), 0);
    assert_int_equal(t3r_mark_flying(s->view, 2, 1, 0, false, &alone), 36);
    for (int i = 0; i < PIXELS; i++) {
        bool flies = i % W >= 20 && i % W < 26 && i / W >= 10 && i / W < 16;
        assert_int_equal(s->validity[1][i], i == 12 * W + 22 ? T3R_FILLED | T3R_MARK_DOUBTFUL
                                            : flies          ? T3R_MEASURED | T3R_MARK_DOUBTFUL
                                                             : T3R_MEASURED);
    }
    /* an object that both see is none, nor one seen a pixel off, nor what the other view has no depth for */
    for (int off = -1; off <= 1; off++) {
        t3r_reset_comparison(s->view, 2);
        block(s, 0, 0, 0, W, H, 2);
        block(s, 0, 36 + off, 10, 42 + off, 16, 1);
        assert_int_equal(
            t3r_mark_flying(s->view, 2, 0, 0, false, &alone) + t3r_mark_flying(s->view, 2, 1, 0, false, &alone), 0);
    }
    block(s, 0, 0, 0, W, H, 2);
    memset(s->validity[0], T3R_NO_DEPTH, PIXELS);
    assert_int_equal(t3r_mark_flying(s->view, 2, 1, 0, false, &alone), 0);
    /* guesses bear witness against guesses, not against what was measured */
    memset(s->validity[0], T3R_FILLED, PIXELS);
    assert_int_equal(t3r_mark_flying(s->view, 2, 1, 0, false, &alone), 0);
    t3r_reset_comparison(s->view, 2);
    s->validity[1][12 * W + 22] = T3R_FILLED;
    assert_int_equal(t3r_mark_flying(s->view, 2, 1, 0, true, &alone), 1);
    assert_int_equal(s->validity[1][12 * W + 22], T3R_FILLED | T3R_MARK_DOUBTFUL);
    free(s);
}

/* --- redundancy --------------------------------------------------------------------------------------------------- */

/* As good as each other: the earlier view stays whole, the later one keeps what it alone sees. */
TEST(the_earlier_of_two)
{
    rig *s = pair_new();
    s->validity[1][3 * W + 3] = T3R_FILLED;
    s->validity[1][3 * W + 4] = T3R_MEASURED | T3R_MARK_DOUBTFUL;
    assert_int_equal(mark_covered(s, 2), (W - 8) * H - 1);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(s->validity[0][i], T3R_MEASURED);
        assert_int_equal(s->validity[1][i], i == 3 * W + 3   ? T3R_FILLED | T3R_MARK_COVERED
                                            : i == 3 * W + 4 ? T3R_MEASURED | T3R_MARK_DOUBTFUL
                                            : i % W < W - 8  ? T3R_MEASURED | T3R_MARK_COVERED
                                                             : T3R_MEASURED);
    }
    t3r_reset_comparison(s->view, 2);
    assert_int_equal(s->validity[1][3 * W + 3], T3R_FILLED);
    assert_int_equal(s->validity[1][0], T3R_MEASURED);
    free(s);
}

/* The nearer view is kept, whichever comes first; a longer lens counts as nearness. */
TEST(the_nearer_of_two)
{
    for (int nearer = 0; nearer < 2; nearer++) {
        for (int lens = 0; lens < 2; lens++) {
            rig *s = unit_array(1, sizeof *s);
            place_view(s, nearer, 0, lens ? 0 : 0.5, 2);
            place_view(s, 1 - nearer, 0, 0, 2);
            if (lens) {
                s->view[nearer].fx_q16 = s->view[nearer].fy_q16 = F * 4 / 3 << 16;
            }
            uint32_t marked = mark_covered(s, 2);
            uint32_t inside = 0; /* of the farther view: its middle three quarters */
            for (int i = 0; i < PIXELS; i++) {
                assert_int_equal(s->validity[nearer][i], T3R_MEASURED);
                inside += s->validity[1 - nearer][i] == (T3R_MEASURED | T3R_MARK_COVERED);
            }
            assert_int_equal(marked, inside);
            assert_in_range(marked, PIXELS * 9 / 16 * 93 / 100, PIXELS * 9 / 16 * 107 / 100);
            free(s);
        }
    }
}

/* A later view that is only a little nearer does not take over; the earlier one is kept whole. */
TEST(a_little_nearer_is_as_good)
{
    const double nearer[] = {0.08, 0.16}; /* 1/25 and 2/25 of the depth: one part in 16 is between */
    for (int turn = 0; turn < 2; turn++) {
        rig *s = unit_array(1, sizeof *s);
        place_view(s, 0, 0, 0, 2);
        place_view(s, 1, 0, nearer[turn], 2);
        assert_true(mark_covered(s, 2) > PIXELS * 3 / 4);
        for (int i = 0; i < PIXELS; i++) {
            assert_int_equal(s->validity[turn][i], T3R_MEASURED);
        }
        free(s);
    }
}

TEST(other_surfaces_stay)
{
    rig *s = pair_new();
    block(s, 1, 20, 10, 26, 16, 1.9); /* 1/20 off */
    assert_int_equal(mark_covered(s, 2), (W - 8) * H - 36);
    assert_int_equal(s->validity[1][12 * W + 22], T3R_MEASURED);
    free(s);
}

/* Whatever the depths: every covered pixel has one that covers it, measured and itself retained. */
TEST(no_surface_is_lost)
{
    uint64_t seed = 5;
    uint32_t all = 0;
    for (int turn = 0; turn < 20; turn++) {
        rig *s = unit_array(1, sizeof *s);
        for (int v = 0; v < VIEWS; v++) {
            place_view(s, v, (double)unit_between(&seed, -30, 30) / 100, (double)unit_between(&seed, -20, 20) / 100, 2);
            for (int i = 0; i < PIXELS; i++) {
                s->depth[v][i] = (uint16_t)((int64_t)s->depth[v][i] + unit_between(&seed, -150, 150));
                int64_t kind = unit_between(&seed, 0, 9);
                s->validity[v][i] = kind == 0 ? T3R_NO_DEPTH : kind == 1 ? T3R_FILLED : T3R_MEASURED;
            }
        }
        all += mark_covered(s, VIEWS);
        for (uint32_t v = 0; v < VIEWS; v++) {
            t3r_pointmap from = t3r_pointmap_of(&s->view[v], 0);
            for (uint32_t i = 0; i < PIXELS; i++) {
                bool witnessed = false;
                for (uint32_t w = 0; w < VIEWS && t3r_is_covered(s->validity[v][i]); w++) {
                    t3r_pointmap to = t3r_pointmap_of(&s->view[w], 0);
                    t3r_projected_pixel projected;
                    if (w == v || !t3r_reproject(&from, i % W, i / W, &to, &projected)) {
                        continue;
                    }
                    double there = s->depth[w][projected.pixel] / (double)UNIT, here = projected.z_q20 / 1048576.0;
                    witnessed |= s->validity[w][projected.pixel] == T3R_MEASURED && fabs(there - here) < 0.0313 * here;
                }
                assert_int_equal(witnessed, t3r_is_covered(s->validity[v][i]));
            }
        }
        free(s);
    }
    assert_true(all > 1000);
}

/* --- scale -------------------------------------------------------------------------------------------------------- */

/* The median depth is brought to 1..2 scene units as far as exponents go, and what is beyond is held there. */
TEST(scale_of_depths)
{
    static const struct {
        int unit, exponent; /* log2 of the depth step, Q40 */
        double median;
    } cases[] = {{30, 1, 1}, {34, 5, 1}, {53, 24, 1}, {54, 24, 2}, {59, 24, 2}, {7, -22, 1}, {2, -24, 1}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        rig *s = unit_array(1, sizeof *s);
        int32_t exponent, again, median_q20;
        place_view_in_steps(s, 0, 0, 0, ldexp(2048, cases[i].unit - 40), UINT64_C(1) << cases[i].unit);
        assert_int_equal(t3r_scene_scale_choose(s->view, 1, &alone, &exponent, &median_q20), T3R_OK);
        assert_int_equal(exponent, cases[i].exponent);
        assert_true(fabs(median_q20 / 1048576.0 - cases[i].median) < 0.002);
        assert_int_equal(t3r_scene_exponent(s->view, 1, &alone, &again), T3R_OK);
        assert_int_equal(exponent, again);
        memset(s->validity[0], T3R_NO_DEPTH, PIXELS);
        assert_int_equal(t3r_scene_scale_choose(s->view, 1, &alone, &exponent, &median_q20), T3R_ERR_NO_DEPTH);
        assert_int_equal(t3r_scene_exponent(s->view, 1, &alone, &again), T3R_ERR_NO_DEPTH);
        free(s);
    }
}

/* --- exposure ----------------------------------------------------------------------------------------------------- */

/* A texture on the plane, seen by view v through a gain a channel; every fifth pixel shows something else. */
static void paint(rig *s, int v, int disparity, const double gain[3])
{
    for (int i = 0; i < PIXELS; i++) {
        uint32_t place = (uint32_t)(i / W * 1000 + i % W + disparity);
        uint32_t noise = t3r_mix32((uint32_t)(i + PIXELS * v) ^ 0x5555u);
        for (int c = 0; c < 3; c++) {
            double level = 60 + t3r_mix32(place * 3 + (uint32_t)c) % 120;
            s->colour[v][c][i] =
                (uint8_t)(noise % 5 == 0 ? (noise >> (8 * c)) & 255 : (uint32_t)lround(level * gain[c]));
        }
    }
}

static double gain_of(const uint16_t gain_q14[3], int c)
{
    return gain_q14[c] / 16384.0;
}

/* A view 0.8 as bright is found out within 1 %, each channel apart, and both are brought to their (geometric) mean. */
TEST(gain_recovered)
{
    const double one[3] = {1, 1, 1};
    const double other[][3] = {{0.8, 0.8, 0.8}, {0.7, 1, 1.3}, {1, 1, 1}};
    for (int turn = 0; turn < 3; turn++) {
        rig *s = pair_new();
        paint(s, 0, 0, one);
        paint(s, 1, 8, other[turn]);
        uint16_t gain_q14[2][3];
        t3r_exposure_gains(s->view, 2, 0, gain_q14, &alone);
        for (int c = 0; c < 3; c++) {
            double ratio = gain_of(gain_q14[0], c) / gain_of(gain_q14[1], c);
            assert_true(fabs(ratio / other[turn][c] - 1) < 0.01);
            assert_true(fabs(gain_of(gain_q14[0], c) * gain_of(gain_q14[1], c) - 1) < 0.005);
        }
        free(s);
    }
}

/* More than an octave brighter or darker counts as an octave. */
TEST(gains_are_held)
{
    for (int turn = 0; turn < 2; turn++) {
        rig *s = pair_new();
        for (int v = 0; v < 2; v++) {
            for (int c = 0; c < 3; c++) {
                memset(s->colour[v][c], v == turn ? 20 : 220, PIXELS);
            }
        }
        uint16_t gain_q14[2][3];
        assert_int_equal(t3r_exposure_gains(s->view, 2, 0, gain_q14, &alone), 2);
        for (int c = 0; c < 3; c++) {
            const double ratio = gain_of(gain_q14[turn], c) / gain_of(gain_q14[1 - turn], c);
            assert_true(fabs(log2(ratio) - 1) < 2.0 / 256);
        }
        free(s);
    }
}

/* A view that shares too little keeps its colours and moves no other's. */
TEST(unlinked_views_stay)
{
    const double one[3] = {1, 1, 1}, dark[3] = {0.8, 0.8, 0.8};
    rig *s = pair_new();
    place_view(s, 2, 0, 0, 4); /* on another plane */
    paint(s, 0, 0, one);
    paint(s, 1, 8, dark);
    paint(s, 2, 0, dark);
    uint16_t with[3][3], without[2][3], by_itself[3][3];
    t3r_exposure_gains(s->view, 3, 0, with, &alone);
    t3r_exposure_gains(s->view, 2, 0, without, &alone);
    assert_memory_equal(with, without, sizeof without);
    place_view(s, 1, 0, 0, 8);
    t3r_exposure_gains(s->view, 3, 0, by_itself, &alone);
    for (int c = 0; c < 3; c++) {
        assert_int_equal(with[2][c], T3R_GAIN_ONE_Q14);
        for (int v = 0; v < 3; v++) {
            assert_int_equal(by_itself[v][c], T3R_GAIN_ONE_Q14);
        }
    }
    free(s);
}

TEST(levelled_colours)
{
    for (uint32_t level = 0; level <= 255; level++) {
        assert_int_equal(t3r_level_q7(level * 128, T3R_GAIN_ONE_Q14), level * 128);
        for (uint32_t gain = 4096; gain <= UINT16_MAX; gain += 4093) {
            double exact = fmin(level * 128 * (gain / 16384.0), 255 * 128);
            assert_true(fabs(t3r_level_q7(level * 128, (uint16_t)gain) - exact) <= 0.5);
        }
    }
}

/* --- through the interface ---------------------------------------------------------------------------------------- */

typedef struct trace {
    uint64_t hash[T3R_STAGE_COUNT];
    int calls, cancel_at; /* progress calls in stage pointmap; the one that cancels, from 1 */
} trace;

static void note_hash(void *user, t3r_stage stage, uint64_t hash)
{
    ((trace *)user)->hash[stage] = hash;
}

static int count_calls(void *user, t3r_stage stage, uint32_t done, uint32_t total)
{
    trace *t = user;
    assert_true(done < total || stage != T3R_STAGE_POINTMAP);
    t->calls += stage == T3R_STAGE_POINTMAP;
    return stage == T3R_STAGE_POINTMAP && t->calls == t->cancel_at;
}

/* Two frames of the plane with a floating block, the second darker. */
static void add_frames(t3r_runtime *rt)
{
    static uint8_t rgb[PIXELS * 3], depth[PIXELS * 2];
    for (int v = 0; v < 2; v++) {
        for (int i = 0; i < PIXELS; i++) {
            uint32_t steps = v == 1 && i % W >= 20 && i % W < 26 && i / W >= 10 && i / W < 16 ? UNIT : 2 * UNIT;
            depth[2 * i] = (uint8_t)steps;
            depth[2 * i + 1] = (uint8_t)(steps >> 8);
            for (int c = 0; c < 3; c++) {
                uint32_t level = 60 + t3r_mix32((uint32_t)((i / W * 1000 + i % W + 8 * v) * 3 + c)) % 120;
                rgb[3 * i + c] = (uint8_t)(v == 0 ? level : level * 4 / 5);
            }
        }
        t3r_frame frame = rgbd_frame(rgb, depth, W, H, UNIT_Q40);
        t3r_camera camera = {.fx_q16 = F << 16,
                             .fy_q16 = F << 16,
                             .cx_q16 = (W / 2) << 16,
                             .cy_q16 = (H / 2) << 16,
                             .position_q32 = {(int64_t)v << 30},
                             .rotation_q30 = {1 << 30}};
        assert_int_equal(t3r_add_view(rt, &frame, &camera), T3R_OK);
    }
}

static uint32_t of_view(const t3r_scene *scene, uint8_t view, uint8_t confidence)
{
    uint32_t count = 0;
    for (uint32_t i = 0; i < scene->count; i++) {
        count += scene->gaussians[i].view == view && scene->gaussians[i].confidence == confidence;
    }
    return count;
}

TEST(in_the_pipeline)
{
    const uint32_t all = 2 * PIXELS;
    const int comparisons = 3 * 2 + 2 + 1 + 2; /* bridging, flying pixels, exposure, redundancy */
    for (int mode = T3R_ALLOCATE_CONFIGURED + 1; mode < T3R_ALLOCATE_GIVEN; mode++) {
        t3r_config config = t3r_default_config(W, H, 2, all);
        config.rim = 0;
        config.clusters = 20;
        config.keep_analysis = 1;
        config.flying = config.redundancy = config.exposure = 1;
        config.align = 0;
        config.gaussians = 300;
        config.allocate = (t3r_allocation)mode;
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
        void *arena = aligned_alloc(T3R_ARENA_ALIGN, (plan.bytes + 63) / 64 * 64);
        assert_non_null(arena);
        t3r_runtime *rt;
        t3r_scene scene;
        assert_int_equal(t3r_init(&rt, arena, plan.bytes, &config), T3R_OK);
        trace first = {.cancel_at = 0}, second = {.cancel_at = 0};
        t3r_hooks hooks = {.user = &first, .progress = count_calls, .stage_hash = note_hash};
        assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
        add_frames(rt);
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        assert_int_equal(first.calls, comparisons);

        /* few: nothing that is covered or floats */
        assert_int_equal(scene.count, 300);
        assert_int_equal(scene.valid_points, all);
        assert_int_equal(of_view(&scene, 0, 255) + of_view(&scene, 1, 255), 300);
        /* many: the covered ones compete, the floating block still does not; all: it comes last */
        assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = all - 36}, &scene), T3R_OK);
        assert_int_equal(scene.count, all - 36);
        assert_int_equal(of_view(&scene, 1, 64), 0);
        assert_true(of_view(&scene, 1, 192) > 2000);
        assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = all}, &scene), T3R_OK);
        assert_int_equal(scene.count, all);
        assert_int_equal(of_view(&scene, 1, 64), 36);

        /* the same again, and after a cancel anywhere among the views' comparisons, which no mode changes */
        assert_int_equal(t3r_rebuild(rt, &(t3r_request){.gaussians = 300}, &scene), T3R_OK);
        for (int cancel = 0; cancel <= (mode == T3R_ALLOCATE_DENSITY ? comparisons : 0); cancel++) {
            second = (trace){.cancel_at = cancel};
            hooks.user = &second;
            assert_int_equal(t3r_set_hooks(rt, &hooks), T3R_OK);
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), cancel == 0 ? T3R_OK : T3R_ERR_CANCELLED);
            second.cancel_at = 0;
            assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
            assert_memory_equal(first.hash, second.hash, sizeof first.hash);
        }
        free(arena);
    }
}

/* Levelled splats of both views agree in their mean; left alone they are a fifth apart. */
TEST(splats_are_levelled)
{
    for (uint32_t on = 0; on < 2; on++) {
        t3r_config config = t3r_default_config(W, H, 2, 2 * PIXELS);
        config.rim = 0;
        config.clusters = 20;
        config.exposure = on;
        t3r_plan_info plan;
        assert_int_equal(t3r_plan(&config, &plan), T3R_OK);
        void *arena = aligned_alloc(T3R_ARENA_ALIGN, (plan.bytes + 63) / 64 * 64);
        assert_non_null(arena);
        t3r_runtime *rt;
        t3r_scene scene;
        assert_int_equal(t3r_init(&rt, arena, plan.bytes, &config), T3R_OK);
        add_frames(rt);
        assert_int_equal(t3r_reconstruct(rt, NULL, &scene), T3R_OK);
        double sum[2] = {0};
        for (uint32_t i = 0; i < scene.count; i++) {
            sum[scene.gaussians[i].view] += scene.gaussians[i].colour_q7[1];
        }
        double ratio = sum[1] / sum[0];
        assert_true(on ? fabs(ratio - 1) < 0.02 : fabs(ratio - 0.8) < 0.02);
        free(arena);
    }
}

/* --- disagreement ------------------------------------------------------------------------------------------------- */

static void paint_sure(rig *s, int v, int disparity, const double gain[3])
{
    for (int i = 0; i < PIXELS; i++) {
        uint32_t place = (uint32_t)(i / W * 4096 + i % W + disparity);
        for (int c = 0; c < 3; c++) {
            s->colour[v][c][i] = (uint8_t)lround((60 + t3r_mix32(place * 3 + (uint32_t)c) % 120) * gain[c]);
        }
    }
}

/* A wall whose colours differ by 9 levels in red and by nothing else: 27 a channel, whatever the exposure; what has
 * other depth, is doubtful or was not measured does not count. */
TEST(colours_that_differ)
{
    rig *s = pair_new();
    const double same[3] = {1, 1, 1};
    uint16_t gain_q14[VIEWS][3] = {{T3R_GAIN_ONE_Q14, T3R_GAIN_ONE_Q14, T3R_GAIN_ONE_Q14},
                                   {T3R_GAIN_ONE_Q14, T3R_GAIN_ONE_Q14, T3R_GAIN_ONE_Q14}};
    uint32_t pairs;
    paint_sure(s, 0, 0, same);
    paint_sure(s, 1, 8, same);
    assert_int_equal(t3r_disagreement_q8(s->view, 2, 0, gain_q14, 1, &pairs, NULL), 0);
    assert_int_equal(pairs, 2 * (W - 8) * H);
    assert_int_equal(t3r_disagreement_q8(s->view, 1, 0, gain_q14, 1, &pairs, NULL), 0);
    assert_int_equal(pairs, 0);
    for (int i = 0; i < PIXELS; i++) {
        s->colour[1][0][i] = (uint8_t)(s->colour[1][0][i] + 9);
    }
    assert_int_equal(t3r_disagreement_q8(s->view, 2, 0, gain_q14, 1, &pairs, NULL), 27 * 256);
    assert_int_equal(t3r_disagreement_q8(s->view, 2, 0, gain_q14, 2, &pairs, NULL), 27 * 256);
    assert_int_equal(pairs, 2 * ((W - 8) / 2) * (H / 2));

    block(s, 1, 0, 0, W, H / 2, 1.9);
    memset(s->validity[1] + PIXELS / 2, T3R_MEASURED | T3R_MARK_DOUBTFUL, 4 * W);
    memset(s->validity[1] + PIXELS / 2 + 4 * W, T3R_FILLED, 3 * W);
    memset(s->validity[1] + PIXELS / 2 + 7 * W, T3R_MEASURED | T3R_MARK_COVERED, 3 * W); /* measured all the same */
    assert_int_equal(t3r_disagreement_q8(s->view, 2, 0, gain_q14, 1, &pairs, NULL), 27 * 256);
    assert_int_equal(pairs, 2 * (W - 8) * (H / 2 - 7));
    free(s);
}

/* Colours that differ alike from pixel to pixel are shared by neighbours, those that differ the other way are not, and
 * noise is hardly. A pair whose right neighbour is none does not count. */
TEST(differences_that_neighbours_share)
{
    rig *s = pair_new();
    const double same[3] = {1, 1, 1};
    uint16_t gain_q14[VIEWS][3] = {{T3R_GAIN_ONE_Q14, T3R_GAIN_ONE_Q14, T3R_GAIN_ONE_Q14},
                                   {T3R_GAIN_ONE_Q14, T3R_GAIN_ONE_Q14, T3R_GAIN_ONE_Q14}};
    enum { ALIKE, IN_TURN, NOISE, ALONE };
    for (int kind = ALIKE; kind <= ALONE; kind++) {
        paint_sure(s, 0, 0, same);
        paint_sure(s, 1, 8, same);
        for (int i = 0; i < PIXELS; i++) {
            const bool less = (kind == IN_TURN && i % 2 != 0) || (kind == NOISE && t3r_mix32((uint32_t)i) % 2 != 0);
            s->colour[1][0][i] = (uint8_t)(s->colour[1][0][i] + (less ? -9 : 9));
            s->validity[1][i] = kind == ALONE && i % 2 != 0 ? T3R_FILLED : T3R_MEASURED;
        }
        for (uint32_t step = 1; step <= 2; step++) {
            uint32_t pairs;
            int32_t shared_q8;
            assert_int_equal(t3r_disagreement_q8(s->view, 2, 0, gain_q14, step, &pairs, &shared_q8), 27 * 256);
            assert_in_range(pairs, 64, PIXELS * 2);
            if (kind == NOISE) {
                assert_true(abs(shared_q8) < 4 * 256);
            } else {
                assert_int_equal(shared_q8, kind == ALIKE ? 27 * 256 : kind == IN_TURN ? -27 * 256 : 0);
            }
        }
    }
    free(s);
}

TEST(levelled_before_they_are_compared)
{
    rig *s = pair_new();
    const double same[3] = {1, 1, 1}, darker[3] = {0.8, 0.9, 1};
    paint_sure(s, 0, 0, same);
    paint_sure(s, 1, 8, darker);
    uint16_t gain_q14[VIEWS][3];
    t3r_exposure_gains(s->view, 2, 0, gain_q14, &alone);
    uint32_t pairs;
    assert_true(t3r_disagreement_q8(s->view, 2, 0, gain_q14, 1, &pairs, NULL) < 2 * 256);
    for (int c = 0; c < 3; c++) {
        gain_q14[0][c] = gain_q14[1][c] = T3R_GAIN_ONE_Q14;
    }
    assert_true(t3r_disagreement_q8(s->view, 2, 0, gain_q14, 1, &pairs, NULL) > 50 * 256);
    free(s);
}

/* Three views in a ring: each is compared with both others. */
TEST(around_the_ring)
{
    rig *s = pair_new();
    const double same[3] = {1, 1, 1};
    place_view(s, 2, 0.5, 0, 2);
    uint16_t gain_q14[VIEWS][3];
    for (int v = 0; v < VIEWS; v++) {
        paint_sure(s, v, 8 * v, same);
        for (int c = 0; c < 3; c++) {
            gain_q14[v][c] = T3R_GAIN_ONE_Q14;
        }
    }
    uint32_t pairs;
    assert_int_equal(t3r_disagreement_q8(s->view, 3, 0, gain_q14, 1, &pairs, NULL), 0);
    assert_int_equal(pairs, 2 * H * ((W - 8) + (W - 8) + (W - 16)));
    free(s);
}
