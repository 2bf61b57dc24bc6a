/* SPDX-License-Identifier: Apache-2.0 */
/* The density of a stream's map: each Gaussian counts as one, wherever it lies and whatever hides it; widths follow the
 * density and are bounded; the keys that it takes leave no room where the map is dense enough. */
#include "unit/unit.h"

#include "budget/budget_keys.h"
#include "core/fixed.h"
#include "stream/stream_density.h"

enum { WIDTH = 40, HEIGHT = 30, PIXELS = WIDTH * HEIGHT, MOST = 2000, FOCAL = 32 };

typedef struct site {
    t3r_gaussian gaussians[MOST];
    t3r_map_record records[MOST];
    t3r_map map;
    uint8_t validity[PIXELS];
    uint16_t depth[PIXELS], texture[PIXELS], key[PIXELS];
    t3r_map_disc discs[MOST];
    uint32_t plane[PIXELS];
    t3r_view view;
    t3r_pointmap keyframe;
    t3r_workers workers;
    t3r_map_density density;
} site;

/* A wall two scene units away, without Gaussians. */
static void open_site(site *s)
{
    memset(s, 0, sizeof *s);
    for (int i = 0; i < PIXELS; i++) {
        s->depth[i] = 2000;
        s->validity[i] = T3R_MEASURED;
    }
    s->view = (t3r_view){.width = WIDTH,
                         .height = HEIGHT,
                         .depth = s->depth,
                         .validity = s->validity,
                         .texture = s->texture,
                         .key = s->key,
                         .fx_q16 = FOCAL << 16,
                         .fy_q16 = FOCAL << 16,
                         .cx_q16 = (WIDTH << 15) - (1 << 15),
                         .cy_q16 = (HEIGHT << 15) - (1 << 15),
                         .depth_unit_q40 = UINT64_C(1099511628), /* 0.001 */
                         .pose = {.rotation_q30 = {1 << 30, 0, 0, 0, 1 << 30, 0, 0, 0, 1 << 30}}};
    s->keyframe = t3r_pointmap_of(&s->view, 0);
    s->workers = (t3r_workers){NULL, 1};
    s->map = (t3r_map){s->gaussians, s->records, 0};
    s->density = (t3r_map_density){&s->map, &s->keyframe, &s->workers, s->discs, s->plane};
}

/* Adds a Gaussian of the keyframe's own grain at a pixel, as wide as its spacing. */
static void add(site *s, double u, double v, double z, int density_q10)
{
    t3r_gaussian *g = &s->gaussians[s->map.count];
    const double at[3] = {(u - (WIDTH - 1) / 2.0) * z / FOCAL, (v - (HEIGHT - 1) / 2.0) * z / FOCAL, z};
    const double spacing = z / FOCAL * exp2(-density_q10 / 2048.0);
    for (int k = 0; k < 3; k++) {
        g->position_q20[k] = (int32_t)lround(at[k] * 1048576);
        g->factor[4 * k] = (int16_t)(k == 2 ? 0 : 16384);
    }
    g->factor_exponent = (int8_t)lround(log2(spacing / 16384));
    s->records[s->map.count++] = (t3r_map_record){.density_q10 = (int16_t)density_q10,
                                                  .grain_q8 = (int16_t)t3r_grain_q8(&s->view, g->position_q20[2])};
}

static double sum_of(const site *s)
{
    double sum = 0;
    for (int i = 0; i < PIXELS; i++) {
        sum += s->plane[i] / 65536.0;
    }
    return sum;
}

/* The plane sums to the number of Gaussians on the wall that the picture shows, of any width. */
TEST(each_counts_as_one)
{
    static site s;
    uint64_t seed = 3;
    for (int round = 0; round < 40; round++) {
        open_site(&s);
        const int spread_q10 = -(int)unit_between(&seed, 0, 6000), count = (int)unit_between(&seed, 1, 300);
        const double margin = 2 * exp2(-spread_q10 / 2048.0) + 1; /* wholly inside */
        for (int i = 0; i < count && 2 * margin < HEIGHT - 2; i++) {
            const double u = margin + (WIDTH - 1 - 2 * margin) * (double)unit_between(&seed, 0, 999) / 999;
            const double v = margin + (HEIGHT - 1 - 2 * margin) * (double)unit_between(&seed, 0, 999) / 999;
            add(&s, u, v, 2, spread_q10);
        }
        t3r_map_density_find(&s.density);
        assert_true(fabs(sum_of(&s) - s.map.count) <= 0.02 * s.map.count);
    }
}

/* Gaussians before the wall and behind it count nothing; at the border a part; next to a step only its own side. */
TEST(counts_on_its_own_surface)
{
    static site s;
    open_site(&s);
    add(&s, 20, 15, 1.2, -4096);
    add(&s, 20, 15, 3.5, -4096);
    t3r_map_density_find(&s.density);
    assert_true(sum_of(&s) == 0);
    add(&s, -0.4, 15, 2, -4096);
    t3r_map_density_find(&s.density);
    assert_true(sum_of(&s) > 0.4 && sum_of(&s) < 0.7);
    open_site(&s);
    for (int i = 0; i < PIXELS; i++) {
        s.depth[i] = i % WIDTH < 20 ? 2000 : 4000;
    }
    add(&s, 19, 15, 2, -4096);
    t3r_map_density_find(&s.density);
    assert_true(fabs(sum_of(&s) - 1) < 0.01);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(i % WIDTH < 20 || s.plane[i] == 0);
    }
}

/* The disc of a Gaussian as sparse as its distance reaches from the first step of depth on. */
TEST(discs_that_reach_the_camera)
{
    static site s;
    open_site(&s);
    s.view.fx_q16 = s.view.fy_q16 = 8 << 16;
    add(&s, (WIDTH - 1) / 2.0, (HEIGHT - 1) / 2.0, 2, -8000);
    t3r_map_discs_find(&s.map, &s.keyframe, &s.workers, s.discs);
    assert_int_equal(s.discs[0].nearest, 1);
    assert_in_range(s.discs[0].farthest, 6124, 6125); /* 2 + 2 x 16 / 8 + 2 / 16 */
}

/* The disc of a Gaussian at the end of the map's range reaches as far as depths do, and no farther. */
TEST(discs_at_the_end_of_the_range)
{
    static site s;
    open_site(&s);
    s.view.depth_unit_q40 = UINT64_C(1) << 36;
    s.keyframe = t3r_pointmap_of(&s.view, 0);
    add(&s, (WIDTH - 1) / 2.0, (HEIGHT - 1) / 2.0, 2040, 0);
    t3r_map_discs_find(&s.map, &s.keyframe, &s.workers, s.discs);
    assert_int_equal(s.discs[0].farthest, 2048 * 16 - 1);
}

/* Fills the wall with a regular grid of Gaussians, `step` pixels apart, noted as of another density. Returns a central
 * one. */
static uint32_t fill_wall(site *s, int step, int noted_q10)
{
    uint32_t middle = 0;
    open_site(s);
    for (int v = -2 * step; v < HEIGHT + 2 * step; v += step) {
        for (int u = -2 * step; u < WIDTH + 2 * step; u += step) {
            middle = v <= HEIGHT / 2 && u <= WIDTH / 2 ? s->map.count : middle;
            add(s, u, v, 2, noted_q10);
        }
    }
    return middle;
}

static double width_of(const t3r_gaussian *g)
{
    return g->factor[0] * exp2(g->factor_exponent);
}

/* Widths that are noted twice too wide or too narrow reach those of the real spacing, and stay there. */
TEST(widths_follow_the_density)
{
    static site s;
    for (int off_q10 = -2048; off_q10 <= 2048; off_q10 += 2048) {
        const int real_q10 = -2 * (int)lround(log2(3) * 1024);
        const uint32_t middle = fill_wall(&s, 3, T3R_MIN(real_q10 + off_q10, 0));
        const double before = width_of(&s.gaussians[middle]);
        for (int n = 0; n < 40; n++) {
            t3r_map_density_find(&s.density);
            t3r_map_density_fit(&s.density);
        }
        assert_true(abs(s.records[middle].density_q10 - real_q10) <= 400);
        const double factor = exp2((T3R_MIN(real_q10 + off_q10, 0) - s.records[middle].density_q10) / 2048.0);
        assert_true(fabs(width_of(&s.gaussians[middle]) / before / factor - 1) < 0.02);
        const int settled_q10 = s.records[middle].density_q10;
        t3r_map_density_find(&s.density);
        t3r_map_density_fit(&s.density);
        assert_int_equal(s.records[middle].density_q10, settled_q10);
    }
}

/* Widths depend on the noted density alone, whatever comes between. After 10,000 cycles of densities a Gaussian is as
 * it was, but for the rounding of mantissas. */
TEST(widths_return_with_the_density)
{
    uint64_t seed = 11;
    for (int trial = 0; trial < 50; trial++) {
        t3r_map_record record = {.density_q10 = (int16_t)unit_between(&seed, T3R_LEAST_DENSITY_Q10, 0)};
        t3r_gaussian g = {.factor_exponent = -17};
        for (int k = 0; k < 9; k++) {
            g.factor[k] = (int16_t)(k == 0 ? 16384 : unit_between(&seed, -16384, 16384));
        }
        const t3r_gaussian before = g;
        const int here_q10 = record.density_q10;
        const int other_q10[3] = {(int)unit_between(&seed, T3R_LEAST_DENSITY_Q10, 0),
                                  T3R_MAX(here_q10 - (int)unit_between(&seed, 1, 255), T3R_LEAST_DENSITY_Q10),
                                  T3R_MIN(here_q10 + (int)unit_between(&seed, 1, 255), 0)};
        for (int n = 0; n < 10000; n++) {
            for (int k = 0; k < 3; k++) {
                t3r_map_set_density(&g, &record, other_q10[k]);
            }
            t3r_map_set_density(&g, &record, here_q10);
        }
        for (int k = 0; k < 9; k++) {
            const double now = g.factor[k] * exp2(g.factor_exponent - before.factor_exponent);
            assert_true(fabs(now - before.factor[k]) <= 32);
        }
    }
}

/* Widths stay within a quarter of the spacing and four times it; those that refinement leaves alone do not change. */
TEST(widths_are_bounded)
{
    static site s;
    for (int octaves = -9; octaves <= 9; octaves++) {
        const uint32_t middle = fill_wall(&s, 3, -2 * (int)lround(log2(3) * 1024));
        const double usual = width_of(&s.gaussians[middle]);
        s.gaussians[middle].factor_exponent = (int8_t)(s.gaussians[middle].factor_exponent + octaves);
        s.gaussians[middle + 1] = s.gaussians[middle];
        s.records[middle + 1].idle = T3R_MAX_VIEWS + 1;
        for (int n = 0; n < 3; n++) { /* four octaves at most in each */
            t3r_map_density_find(&s.density);
            t3r_map_density_fit(&s.density);
        }
        const double width = width_of(&s.gaussians[middle]) / usual;
        assert_true(width > 0.12 && width < 4.1);
        assert_true(abs(octaves) > 1 || fabs(log2(width) - octaves) < 0.01);
        assert_true(width_of(&s.gaussians[middle + 1]) == usual * exp2(octaves));
    }
}

/* Without any Gaussian, keys are raised to the least key of the map alone. */
TEST(no_key_is_below_the_least)
{
    static site s;
    const t3r_budget_settings settings = {.allocate = T3R_ALLOCATE_PIXEL, .clusters = 1, .gamma_q8 = 256};
    open_site(&s);
    s.key[9] = 60000;
    t3r_map_density_find(&s.density);
    t3r_map_density_raise_keys(&s.density, &settings, &t3r_kernels_c);
    for (int i = 0; i < PIXELS; i++) {
        assert_int_equal(s.key[i], i == 9 ? 60000 : T3R_MAP_KEY_LEAST);
    }
}

/* A wall of one Gaussian in nine pixels takes all thresholds below 4 / 9; of one in two, all. */
TEST(keys_are_raised)
{
    static site s;
    const t3r_budget_settings settings = {.allocate = T3R_ALLOCATE_PIXEL, .clusters = 1, .gamma_q8 = 256};
    const int texture_q10 = t3r_log_wanted_q10(0, &settings);
    (void)fill_wall(&s, 3, -2 * (int)lround(log2(3) * 1024));
    s.key[PIXELS / 2] = 60000;
    s.key[3] = 7; /* a sure point */
    t3r_map_density_find(&s.density);
    t3r_map_density_raise_keys(&s.density, &settings, &t3r_kernels_c);
    const int key = T3R_KEY_ZERO + (int)lround(log2(4.0 / 9) * 1024) - texture_q10;
    for (int i = 0; i < PIXELS; i++) {
        assert_true(s.validity[i] == T3R_MEASURED);
        assert_true(i == PIXELS / 2 ? s.key[i] == 60000 : abs(s.key[i] - key) < 400);
    }
    assert_int_equal(t3r_map_density_mark(&s.density, (uint32_t)key + 400), 0);
    assert_int_equal(t3r_map_density_mark(&s.density, (uint32_t)key - 400), PIXELS);
    (void)fill_wall(&s, 1, 0);
    t3r_map_density_find(&s.density);
    t3r_map_density_raise_keys(&s.density, &settings, &t3r_kernels_c);
    for (int i = 0; i < PIXELS; i++) {
        assert_true(s.plane[i] > UINT16_MAX || s.plane[i] == 0 || s.validity[i] == T3R_MEASURED);
        assert_true(s.plane[i] <= UINT16_MAX || t3r_is_covered(s.validity[i]));
    }
    assert_true(t3r_is_covered(s.validity[5 * WIDTH + 20]));
}
