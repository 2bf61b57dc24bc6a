/* SPDX-License-Identifier: Apache-2.0 */
/* Stereo: depth of a drawn scene, from pairs of every kind. */
#include "unit/unit.h"

#include "core/camera.h"
#include "stereo/stereo.h"
#include "stereo/stereo_depth.h"

enum { W = 120, H = 96, PIXELS = W * H };
static const t3r_stereo_settings settings = {&t3r_kernels_c, 64, 4, 1, {NULL, 1}};
static const double straight[4] = {1, 0, 0, 0};

typedef struct shot {
    t3r_camera camera;
    t3r_view view;
    double depth[PIXELS];
} shot;

/* Computes a smooth random texture: noise on a lattice of `cell`, four octaves. */
static double lattice(int64_t x, int64_t y, int64_t seed)
{
    uint64_t s = (uint64_t)(x * 73856093) ^ (uint64_t)(y * 19349663) ^ (uint64_t)(seed * 83492791);
    return (double)(unit_random(&s) >> 11) / 9007199254740992.0;
}

static double texture(double x, double y, int64_t seed)
{
    double sum = 0;
    for (int octave = 0; octave < 4; octave++) {
        const double scale = 12 << octave, u = x * scale, v = y * scale, a = floor(u), b = floor(v);
        const int64_t i = (int64_t)a, j = (int64_t)b, s = seed + octave;
        const double fx = u - a, fy = v - b;
        sum += (1 - fy) * ((1 - fx) * lattice(i, j, s) + fx * lattice(i + 1, j, s)) +
               fy * ((1 - fx) * lattice(i, j + 1, s) + fx * lattice(i + 1, j + 1, s));
    }
    return sum / 4;
}

/* Draws a leaning wall, z = 3 + 0.3 x, and in front of it a board at z = 2, 1 by 0.8; all at `scale`. */
static shot *shoot(double x, double y, double z, const double q[4], double gain, double scale, int64_t seed)
{
    shot *s = unit_array(1, sizeof *s);
    int32_t r[9];
    s->camera =
        (t3r_camera){.fx_q16 = 110 << 16, .fy_q16 = 110 << 16, .cx_q16 = (W - 1) << 15, .cy_q16 = (H - 1) << 15};
    const double centre[3] = {x, y, z};
    for (int i = 0; i < 4; i++) {
        s->camera.rotation_q30[i] = (int32_t)lround(q[i] * (1 << 30));
    }
    for (int i = 0; i < 3; i++) {
        s->camera.position_q32[i] = llround(centre[i] * scale * 4294967296.0);
    }
    t3r_camera_rotation(s->camera.rotation_q30, r);
    s->view.width = W;
    s->view.height = H;
    for (int c = 0; c < 3; c++) {
        s->view.colour[c] = unit_array(PIXELS, 1);
    }
    s->view.depth = unit_array(PIXELS, 2);
    s->view.match_confidence = unit_array(PIXELS, 1);
    for (int i = 0; i < PIXELS; i++) {
        const double ray[3] = {(i % W - (W - 1) / 2.0) / 110, (i / W - (H - 1) / 2.0) / 110, 1};
        double d[3], value;
        for (int k = 0; k < 3; k++) {
            d[k] = (r[3 * k] * ray[0] + r[3 * k + 1] * ray[1] + r[3 * k + 2] * ray[2]) / (1 << 30);
        }
        double t = (2 - z) / d[2], u = x + t * d[0], v = y + t * d[1];
        if (t > 0 && fabs(u) < 0.5 && fabs(v) < 0.4) {
            value = texture(u, v, seed + 100);
        } else {
            t = (3 + 0.3 * x - z) / (d[2] - 0.3 * d[0]);
            value = texture(x + t * d[0], y + t * d[1], seed);
        }
        s->depth[i] = t * scale;
        for (int c = 0; c < 3; c++) {
            s->view.colour[c][i] = (uint8_t)lround((20 + 200 * value) * gain);
        }
    }
    return s;
}

static void shot_free(shot *s)
{
    for (int c = 0; c < 3; c++) {
        free(s->view.colour[c]);
    }
    free(s->view.depth);
    free(s->view.match_confidence);
    free(s);
}

static t3r_pair match(const t3r_stereo_settings *how, shot *a, shot *b, int garbage, uint64_t *unit)
{
    const size_t bytes = T3R_STEREO_WORK_BYTES(W, H, how->disparities, how->paths);
    void *work = aligned_alloc(64, (bytes + 63) / 64 * 64);
    assert_non_null(work);
    memset(work, garbage, bytes);
    const t3r_camera cameras[2] = {a->camera, b->camera};
    const t3r_view views[2] = {a->view, b->view};
    const t3r_pair pair = t3r_stereo_depth(how, cameras, views, work, unit);
    free(work);
    return pair;
}

/* Computes shares of a view's pixels, percent: matched; of these off by more than `tolerance`; filled. */
static void judge(const shot *s, uint64_t unit, double tolerance, double out[3])
{
    double matched = 0, wrong = 0, filled = 0;
    for (int i = 0; i < PIXELS; i++) {
        const double depth = s->view.depth[i] * (double)unit / 1099511627776.0;
        const uint8_t confidence = s->view.match_confidence[i];
        assert_int_equal(s->view.depth[i] == 0, confidence == T3R_STEREO_NONE);
        matched += confidence >= T3R_STEREO_LEAST;
        filled += confidence == T3R_STEREO_FILLED;
        wrong += confidence >= T3R_STEREO_LEAST && fabs(depth / s->depth[i] - 1) > tolerance;
    }
    out[0] = 100 * matched / PIXELS;
    out[1] = 100 * wrong / (matched > 0 ? matched : 1);
    out[2] = 100 * filled / PIXELS;
}

TEST(pairs)
{
    static const struct {
        const char *name;
        double at[3], q[4], gain, least_matched, tolerance;
    } all[] = {
        {"side by side", {0.25, 0, 0}, {1, 0, 0, 0}, 1, 65, 0.05},
        {"from the right, half as bright", {-0.25, 0, 0}, {1, 0, 0, 0}, 0.5, 65, 0.05},
        {"one above the other", {0, 0.25, 0}, {1, 0, 0, 0}, 1, 65, 0.05},
        {"diagonal", {0.2, 0.15, 0}, {1, 0, 0, 0}, 1, 60, 0.05},
        {"turned inwards", {0.5, 0, 0}, {0.9976, 0, -0.0693, 0}, 1, 50, 0.05},
        {"rolled by a quarter", {0.25, 0, 0}, {0.7071, 0, 0, 0.7071}, 1, 45, 0.05},
        {"forward and sideways", {0.2, 0, 0.35}, {1, 0, 0, 0}, 1, 40, 0.2},
        {"forward", {0, 0, 0.5}, {1, 0, 0, 0}, 1, 40, 0.2},
        {"backward", {0.02, 0.03, -0.5}, {1, 0, 0, 0}, 1, 30, 0.2},
    };
    for (size_t i = 0; i < sizeof all / sizeof *all; i++) {
        for (uint32_t paths = 4; paths <= 8; paths += 4) {
            const t3r_stereo_settings how = {&t3r_kernels_c, 64, paths, 1, {NULL, 1}};
            shot *a = shoot(0, 0, 0, straight, 1, 1, 7);
            shot *b = shoot(all[i].at[0], all[i].at[1], all[i].at[2], all[i].q, all[i].gain, 1, 7);
            uint64_t unit = 0;
            double first[3], second[3];
            assert_int_equal(match(&how, a, b, 0, &unit), T3R_PAIR_OK);
            judge(a, unit, all[i].tolerance, first);
            judge(b, unit, all[i].tolerance, second);
            print_message(
                "%s, %u paths: %.0f and %.0f %% matched, %.1f and %.1f %% of these wrong, %.0f and %.0f %% filled\n",
                all[i].name, paths, first[0], second[0], first[1], second[1], first[2], second[2]);
            assert_true(first[0] > all[i].least_matched && second[0] > all[i].least_matched);
            assert_true(first[1] < 8 && second[1] < 8);
            shot_free(a);
            shot_free(b);
        }
    }
}

/* World units of any size give the same disparities, and so the same depths in steps, up to the baseline's rounding. */
TEST(scales)
{
    for (int exponent = -8; exponent <= 12; exponent += 4) {
        const double scale = ldexp(1, exponent);
        shot *a = shoot(0, 0, 0, straight, 1, scale, 7), *b = shoot(0.25, 0, 0, straight, 1, scale, 7);
        uint64_t unit = 0;
        double shares[3];
        assert_int_equal(match(&settings, a, b, 0, &unit), T3R_PAIR_OK);
        judge(a, unit, 0.05, shares);
        assert_true(shares[0] > 65 && shares[1] < 5);
        shot_free(a);
        shot_free(b);
    }
}

TEST(refused)
{
    uint64_t unit;
    shot *a = shoot(0, 0, 0, straight, 1, 1, 7);
    shot *near = shoot(0.002, 0, 0, straight, 1, 1, 7); /* 0.1 pixels */
    assert_int_equal(match(&settings, a, near, 0, &unit), T3R_PAIR_PARALLAX);
    shot_free(near);

    shot *b = shoot(0.25, 0, 0, straight, 1, 1, 7), *other = shoot(0.25, 0, 0, straight, 1, 1, 5000);
    /* another place: the more candidates pixels have, the fewer match by chance */
    const t3r_stereo_settings many = {&t3r_kernels_c, 128, 4, 1, {NULL, 1}};
    assert_int_equal(match(&many, a, other, 0, &unit), T3R_PAIR_OVERLAP);
    shot_free(other);

    a->camera.position_q32[0] = -(INT64_C(1) << 61);
    b->camera.position_q32[0] = INT64_C(1) << 61;
    assert_int_equal(match(&settings, a, b, 0, &unit), T3R_PAIR_SCALE);
    shot_free(a);
    shot_free(b);
}

/* Neither previous contents of the work memory nor flat or black pictures do harm. */
TEST(repeated)
{
    uint64_t unit[2];
    shot *a = shoot(0, 0, 0, straight, 1, 1, 7), *b = shoot(0.1, 0, 0.4, straight, 1, 1, 7);
    uint16_t *depth = unit_array(2 * PIXELS, 2);
    for (int turn = 0; turn < 2; turn++) {
        assert_int_equal(match(&settings, a, b, turn == 0 ? 0 : 0xa5, &unit[turn]), T3R_PAIR_OK);
        if (turn == 0) {
            memcpy(depth, a->view.depth, PIXELS * 2);
            memcpy(depth + PIXELS, b->view.depth, PIXELS * 2);
        }
    }
    assert_memory_equal(depth, a->view.depth, PIXELS * 2);
    assert_memory_equal(depth + PIXELS, b->view.depth, PIXELS * 2);
    assert_int_equal(unit[0], unit[1]);
    for (int value = 0; value < 256; value += 255) {
        for (int c = 0; c < 3; c++) {
            memset(a->view.colour[c], value, PIXELS);
            memset(b->view.colour[c], value, PIXELS);
        }
        (void)match(&settings, a, b, 0, &unit[0]);
    }
    free(depth);
    shot_free(a);
    shot_free(b);
}

/* Noise for pictures, any settings, any pose: a result, and depths within their range. */
TEST(anything)
{
    uint64_t seed = 6, unit;
    shot *a = shoot(0, 0, 0, straight, 1, 1, 7), *b = shoot(0.25, 0, 0, straight, 1, 1, 7);
    for (int turn = 0; turn < 60; turn++) {
        const t3r_stereo_settings how = {
            &t3r_kernels_c, (uint32_t)unit_between(&seed, 1, 8) * 16, turn % 2 == 0 ? 4 : 8, turn % 5 != 0, {NULL, 1}};
        for (int i = 0; i < 3; i++) {
            b->camera.position_q32[i] = unit_between(&seed, -(INT64_C(3) << 30), INT64_C(3) << 30);
            b->camera.rotation_q30[1 + i] = (int32_t)unit_between(&seed, -(1 << 27), 1 << 27);
        }
        for (int i = 0; i < PIXELS && turn % 3 == 0; i++) {
            b->view.colour[1][i] = (uint8_t)unit_random(&seed);
        }
        if (match(&how, a, b, turn, &unit) == T3R_PAIR_OK) {
            double shares[3];
            assert_true(unit >= 1 && unit < UINT64_C(1) << 47);
            judge(a, unit, 0.05, shares);
            judge(b, unit, 0.05, shares);
        }
    }
    shot_free(a);
    shot_free(b);
}

/* Without filling: the same matches, and nothing between them. */
TEST(unfilled)
{
    uint64_t unit[2];
    shot *a[2], *b[2];
    for (uint32_t fill = 0; fill < 2; fill++) {
        const t3r_stereo_settings how = {&t3r_kernels_c, 64, 4, fill, {NULL, 1}};
        a[fill] = shoot(0, 0, 0, straight, 1, 1, 7);
        b[fill] = shoot(0.25, 0.1, 0, straight, 1, 1, 7);
        assert_int_equal(match(&how, a[fill], b[fill], 0, &unit[fill]), T3R_PAIR_OK);
    }
    int filled = 0;
    assert_int_equal(unit[0], unit[1]);
    for (int i = 0; i < PIXELS; i++) {
        if (a[1]->view.match_confidence[i] >= T3R_STEREO_LEAST) {
            assert_int_equal(a[0]->view.match_confidence[i], a[1]->view.match_confidence[i]);
            assert_int_equal(a[0]->view.depth[i], a[1]->view.depth[i]);
        } else if (a[0]->view.match_confidence[i] == T3R_STEREO_NONE) {
            assert_int_equal(a[0]->view.depth[i], 0);
            filled += a[1]->view.match_confidence[i] == T3R_STEREO_FILLED;
        }
    }
    assert_true(filled > 100);
    for (int i = 0; i < 2; i++) {
        shot_free(a[i]);
        shot_free(b[i]);
    }
}

/* A channel that is almost dark still has contents. */
TEST(dark_is_not_nothing)
{
    uint64_t unit[2];
    shot *a[2], *b[2];
    for (int turn = 0; turn < 2; turn++) {
        a[turn] = shoot(0, 0, 0, straight, 1, 1, 7);
        b[turn] = shoot(0.25, 0, 0, straight, 1, 1, 7);
        for (int c = 0; c < 3; c++) { /* luma 0.1 or 1: the smallest one */
            memset(a[turn]->view.colour[c], turn == 0 ? c == 2 : 1, 40 * W);
            memset(b[turn]->view.colour[c], turn == 0 ? c == 2 : 1, 40 * W);
        }
        assert_int_equal(match(&settings, a[turn], b[turn], 0, &unit[turn]), T3R_PAIR_OK);
    }
    assert_int_equal(unit[0], unit[1]);
    assert_memory_equal(a[0]->view.depth, a[1]->view.depth, PIXELS * 2);
    assert_memory_equal(b[0]->view.depth, b[1]->view.depth, PIXELS * 2);
    for (int turn = 0; turn < 2; turn++) {
        shot_free(a[turn]);
        shot_free(b[turn]);
    }
}

static void by_worker_15(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                         void *context)
{
    (void)user;
    while (count > 0) {
        task(context, --count, 15);
    }
}

static void backwards(void *user, uint32_t count, void (*task)(void *context, uint32_t index, uint32_t worker),
                      void *context)
{
    (void)user;
    while (count > 0) {
        count--;
        task(context, count, count % 2);
    }
}

/* A picture with fewer rows in the first look than workers. */
TEST(small_pictures_have_few_workers)
{
    enum { SIDE = 56, MOST = 16 };
    shot *s[2] = {shoot(0, 0, 0, straight, 1, 1, 7), shoot(0.06, 0, 0, straight, 1, 1, 7)};
    uint8_t colour[2][3][SIDE * SIDE];
    t3r_camera cameras[2];
    t3r_view views[2];
    for (int v = 0; v < 2; v++) {
        cameras[v] = s[v]->camera;
        cameras[v].cx_q16 = cameras[v].cy_q16 = (SIDE - 1) << 15;
        views[v] = (t3r_view){.width = SIDE, .height = SIDE};
        for (int c = 0; c < 3; c++) {
            for (int i = 0; i < SIDE * SIDE; i++) {
                colour[v][c][i] = s[v]->view.colour[c][(i / SIDE + 20) * W + i % SIDE + 32];
            }
            views[v].colour[c] = colour[v][c];
        }
    }
    const size_t bytes = T3R_STEREO_WORK_BYTES(SIDE, SIDE, MOST, 4);
    void *work = aligned_alloc(64, (bytes + 63) / 64 * 64);
    const t3r_hooks hooks = {.parallel_for = by_worker_15};
    const t3r_stereo_settings one = {&t3r_kernels_c, MOST, 4, 1, {NULL, 1}},
                              many = {&t3r_kernels_c, MOST, 4, 1, {&hooks, 16}};
    uint32_t score, shared;
    assert_non_null(work);
    memset(work, 0, bytes);
    const t3r_pair pair = t3r_stereo_match_score(&one, cameras, views, work, &score);
    memset(work, 0xa5, bytes);
    assert_int_equal(t3r_stereo_match_score(&many, cameras, views, work, &shared), pair);
    assert_true(score > 0 && score == shared);
    /* refused before any comparison */
    cameras[1] = cameras[0];
    assert_int_equal(t3r_stereo_match_score(&one, cameras, views, work, &score), T3R_PAIR_NO_BASELINE);
    assert_int_equal(score, 0);
    free(work);
    shot_free(s[0]);
    shot_free(s[1]);
}

/* Two cameras whose first look compares so many disparities that matching leaves no room for the rectified pictures:
 * these are drawn in bands, one per worker; in the larger picture of eight rows, the maximum. Any picture gives the
 * same for any number of workers. */
TEST(bands_where_nothing_is_kept)
{
    enum { SIDE = 53, MOST = 16 };
    static const int32_t focal_q16[2] = {9778159, 8654727};
    static const uint32_t counts[] = {1, 2, 4, 16};
    const t3r_hooks hooks = {.parallel_for = backwards};
    t3r_camera cameras[2] = {{.rotation_q30 = {1 << 30, 130571952, 94199163, -104091023},
                              .position_q32 = {-1710267602, 1984259638, -1927800204}},
                             {.rotation_q30 = {1 << 30, -71127901, -123661275, -73165880},
                              .position_q32 = {166404872, 942228642, 1944734802}}};
    for (int times = 1; times <= 3; times += 2) {
        const uint32_t side = (uint32_t)(times * SIDE);
        const size_t count = (size_t)side * side, bytes = T3R_STEREO_WORK_BYTES(side, side, MOST, 4);
        uint8_t *noise = unit_array(6 * count, 1), *confidence = unit_array(4 * count, 1);
        uint16_t *depth = unit_array(4 * count, 2);
        void *work = aligned_alloc(64, (bytes + 63) / 64 * 64);
        assert_non_null(work);
        uint64_t seed = 3, unit[2] = {0};
        for (size_t i = 0; i < 6 * count; i++) {
            noise[i] = (uint8_t)unit_random(&seed);
        }
        for (size_t k = 0; k < sizeof counts / sizeof counts[0]; k++) {
            const size_t turn = k > 0;
            const t3r_stereo_settings how = {&t3r_kernels_c, MOST, 4, 1, {&hooks, counts[k]}};
            t3r_view views[2];
            for (size_t v = 0; v < 2; v++) {
                cameras[v].fx_q16 = cameras[v].fy_q16 = times * focal_q16[v];
                cameras[v].cx_q16 = cameras[v].cy_q16 = (int32_t)(side - 1) << 15;
                uint8_t *at = noise + 3 * v * count;
                views[v] = (t3r_view){.width = side,
                                      .height = side,
                                      .colour = {at, at + count, at + 2 * count},
                                      .depth = depth + (2 * turn + v) * count,
                                      .match_confidence = confidence + (2 * turn + v) * count};
            }
            memset(work, (int)(60 * k), bytes);
            assert_int_equal(t3r_stereo_depth(&how, cameras, views, work, &unit[turn]), T3R_PAIR_OK); /* by chance */
            assert_int_equal(unit[0], unit[turn]);
            assert_memory_equal(depth, depth + 2 * turn * count, 4 * count);
            assert_memory_equal(confidence, confidence + 2 * turn * count, 2 * count);
        }
        free(work);
        free(noise);
        free(confidence);
        free(depth);
    }
}

/* Makes planes of two disparities, each in half of either view; returns the depth unit of that pair. */
static t3r_pair unit_of(t3r_rectification *rect, const t3r_view views[2], double near, double far, uint64_t *unit_q40,
                        uint32_t *steps)
{
    const size_t pixels = (size_t)rect->width * rect->height;
    uint16_t *disparity = unit_array(pixels, 2);
    uint8_t *confidence = unit_array(pixels, 1);
    for (size_t i = 0; i < pixels; i++) {
        const bool left = i % rect->width < rect->width * 5 / 9;
        disparity[i] = (uint16_t)lround((left ? near : far) * (1 << T3R_DISPARITY_BITS));
        confidence[i] = T3R_STEREO_SURE;
    }
    t3r_stereo_planes planes = {.rect = rect,
                                .disparities = 256,
                                .begin_q16 = {rect->first_q16[0], rect->first_q16[0]},
                                .columns = {rect->width, rect->width},
                                .disparity = {disparity, disparity},
                                .confidence = {confidence, confidence}};
    const t3r_pair pair = t3r_stereo_unit(&t3r_kernels_c, &planes, views, unit_q40);
    *steps = planes.steps;
    free(disparity);
    free(confidence);
    return pair;
}

/* 60,000 steps reach the farthest depth, at most 64 times the median; a step is a whole number of 2^-40 world units,
 * below 2^47. */
TEST(units)
{
    shot *a = shoot(0, 0, 0, straight, 1, 1, 7), *b = shoot(0.25, 0, 0, straight, 1, 1, 7);
    const t3r_view views[2] = {a->view, b->view};
    t3r_rectification rect;
    uint64_t unit;
    uint32_t steps;
    assert_int_equal(t3r_rectify(&a->camera, &b->camera, W, H, 64, &rect), T3R_PAIR_OK);
    for (int far = 1; far <= 100; far *= 10) { /* a disparity of 100 is 1.1 baselines away */
        assert_int_equal(unit_of(&rect, views, 100, 100.0 / far, &unit, &steps), T3R_PAIR_OK);
        const double reach = 60000.0 / steps / (1.1 * T3R_MIN(far, 64));
        assert_true(reach > 0.99 && reach < 1.1);
    }
    assert_int_equal(unit_of(&rect, views, 100, 50, &unit, &steps), T3R_PAIR_OK);
    for (int long_steps = 0; long_steps < 2; long_steps++) { /* for the nearest places, and for the farthest */
        const double disparity = long_steps ? 0.6 : 100;
        rect.baseline_q31 = long_steps ? 3719550786u : rect.baseline_q31; /* 2^31 sqrt 3, the longest possible */
        (void)unit_of(&rect, views, disparity, disparity, &unit, &steps);
        const double exact = (double)rect.baseline_q31 * (1 << 24) / steps;
        int fitting = 0;
        for (rect.baseline_exponent = -80; rect.baseline_exponent < 120; rect.baseline_exponent++) {
            const double wanted = floor(ldexp(exact, rect.baseline_exponent - 47) + 0.5);
            const bool fits = wanted >= 1 && wanted < ldexp(1, 47);
            assert_int_equal(unit_of(&rect, views, disparity, disparity, &unit, &steps),
                             fits ? T3R_PAIR_OK : T3R_PAIR_SCALE);
            assert_true(!fits || fabs((double)unit / wanted - 1) < 1e-6 || fabs((double)unit - wanted) <= 1);
            fitting += fits;
        }
        assert_in_range(fitting, 46, 48);
    }
    shot_free(a);
    shot_free(b);
}

TEST(marks)
{
    uint16_t depth[6] = {0, 5, 5, 5, 5, 5};
    uint8_t confidence[6] = {T3R_STEREO_NONE, T3R_STEREO_FILLED, 2, 29, 30, 255};
    const uint8_t expected[6] = {
        T3R_NO_DEPTH, T3R_FILLED,  T3R_MEASURED | T3R_MARK_DOUBTFUL, T3R_MEASURED | T3R_MARK_DOUBTFUL,
        T3R_MEASURED, T3R_MEASURED};
    const t3r_view view = {.width = 3, .height = 2, .depth = depth, .match_confidence = confidence};
    t3r_stereo_marks(&view, 30);
    assert_memory_equal(confidence, expected, 6);
}
