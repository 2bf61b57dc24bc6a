/* SPDX-License-Identifier: Apache-2.0 */
/* Planes where stereo matched nothing: found among noise and outliers, extended beyond the matches, bounded, the same
 * on views of any size; and outlines that matched outlines. Whole builds are in test_stereo_views.c. */
#include "unit/unit.h"

#include "depth/surroundings.h"
#include "stereo/planes/plane_fill.h"
#include "stereo/planes/plane_outline.h"
#include "stereo/stereo.h"

enum { W = 96, H = 64, PIXELS = W * H };

/* A view and its planes, with the depths of a surface. */
typedef struct shot {
    t3r_view view;
    double truth[PIXELS];
    uint16_t depth[PIXELS];
    uint8_t confidence[PIXELS], colour[3][PIXELS];
} shot;

static _Alignas(64) uint8_t work[T3R_PLANE_FILL_BYTES(W, H)];

static const t3r_camera camera = {
    .fx_q16 = W << 16, .fy_q16 = W << 16, .cx_q16 = W << 15, .cy_q16 = H << 15, .rotation_q30 = {1 << 30, 0, 0, 0}};

/* Fills a view beside another one, which shows nothing unless it is given. */
static void fill(const t3r_view *view, const t3r_view *other, const t3r_camera *there, void *room)
{
    uint8_t *black = unit_array((size_t)view->width * view->height, 1);
    const t3r_view nothing = {.width = view->width, .height = view->height, .colour = {black, black, black}};
    memset(black, 0, (size_t)view->width * view->height);
    const t3r_plane_pair pair = {&t3r_kernels_c, view, other != NULL ? other : &nothing, &camera,
                                 there != NULL ? there : &camera};
    t3r_plane_fill(&pair, room);
    free(black);
}

/* Makes a floor, and behind it a slanted wall, both matched except where x is in from..end - 1. */
static shot *shoot(uint32_t from, uint32_t end)
{
    shot *s = unit_array(1, sizeof *s);
    s->view = (t3r_view){.width = W,
                         .height = H,
                         .colour = {s->colour[0], s->colour[1], s->colour[2]},
                         .depth = s->depth,
                         .match_confidence = s->confidence,
                         .depth_unit_q40 = UINT64_C(1) << 28};
    for (uint32_t i = 0; i < PIXELS; i++) {
        const double x = i % W - W / 2.0, y = i / W - H / 2.0, wall = (1 + 0.004 * x) / 5000, floor = y / 60000;
        s->truth[i] = 1 / fmax(wall, floor);
        s->depth[i] = (uint16_t)lround(s->truth[i]);
        s->confidence[i] = 200;
        for (int c = 0; c < 3; c++) {
            s->colour[c][i] = floor > wall ? 150 : 100;
        }
        if (i % W >= from && i % W < end) {
            s->depth[i] = 0;
            s->confidence[i] = T3R_STEREO_NONE;
        }
    }
    return s;
}

/* Returns the mean relative error of the filled pixels' depth, each counted as at most 1. */
static double off(const shot *s)
{
    uint32_t filled = 0;
    double sum = 0;
    for (uint32_t i = 0; i < PIXELS; i++) {
        const bool is_filled = s->confidence[i] == T3R_STEREO_FILLED;
        filled += is_filled;
        sum += is_filled ? fmin(fabs(s->depth[i] / s->truth[i] - 1), 1) : 0;
        assert_int_not_equal(s->depth[i], 0);
        assert_int_not_equal(s->confidence[i], T3R_STEREO_NONE);
    }
    assert_true(filled > 0);
    print_message("%u are off by %.2f %%\n", filled, 100 * sum / filled);
    return sum / filled;
}

/* Returns the error of the nearest surfaces alone. */
static double plain_off(shot *s)
{
    uint8_t *room = aligned_alloc(64, T3R_SURROUNDINGS_BYTES_(W, H));
    t3r_fill_surroundings(&s->view, T3R_FILLED, room);
    free(room);
    return off(s);
}

TEST(found)
{
    shot *s = shoot(40, 60);
    t3r_planes planes;
    t3r_search_planes(&s->view, work, &planes);
    assert_in_range(planes.count, 2, T3R_PLANES_MOST);
    uint64_t seed = 5;
    for (uint32_t i = 0; i < PIXELS; i++) { /* noise of 1 %; one patch in ten at random */
        s->depth[i] = (uint16_t)(s->depth[i] + s->depth[i] * unit_between(&seed, -10, 10) / 1000);
        if (s->depth[i] != 0 && (i % W / 6 + i / W / 6 * 7) % 10 == 0) {
            s->depth[i] = (uint16_t)unit_between(&seed, 1000, 60000);
        }
    }
    shot *plain = unit_array(1, sizeof *plain);
    *plain = *s;
    plain->view.depth = plain->depth;
    plain->view.match_confidence = plain->confidence;
    fill(&s->view, NULL, NULL, work);
    assert_true(4 * off(s) < 3 * plain_off(plain));
    free(plain);
    free(s);
}

/* Planes continue to the picture's end behind an object, which the nearest surface would continue; matches stay. */
TEST(continued)
{
    shot *all[3] = {shoot(50, W), shoot(50, W), shoot(50, W)}, *s = all[0], *before = all[1], *plain = all[2];
    for (int k = 0; k < 3; k++) {
        for (uint32_t i = 10 * W; i < 50 * W; i++) {
            all[k]->depth[i] =
                (uint16_t)(i % W >= 47 && i % W < 50 ? 2000 : all[k]->depth[i]); /* an object beside it */
        }
    }
    fill(&s->view, NULL, NULL, work);
    assert_true(2 * off(s) < plain_off(plain));
    for (uint32_t i = 0; i < PIXELS; i++) {
        assert_true(before->depth[i] == 0 || i % W >= 44 || before->depth[i] == s->depth[i]);
    }
    free(plain);
    free(before);
    free(s);
}

/* Beside an object, filled pixels keep near to its depth: by more than half up to six pixels away. */
TEST(beside)
{
    shot *both[2] = {shoot(50, W), shoot(50, W)}, *s = both[0], *plain = both[1];
    for (int k = 0; k < 2; k++) {
        for (uint32_t i = 0; i < PIXELS; i++) {
            both[k]->depth[i] = (uint16_t)(i % W >= 47 && i % W < 50 ? 2000 : both[k]->depth[i]);
        }
    }
    fill(&s->view, NULL, NULL, work);
    (void)plain_off(plain);
    for (uint32_t x = 50; x < W; x++) {
        double moved = 0; /* from the object's depth to the wall's */
        for (uint32_t y = 8; y < 24; y++) {
            const uint32_t i = y * W + x;
            const double own = 1.0 / plain->depth[i];
            moved += (1.0 / s->depth[i] - own) / (1 / s->truth[i] - own) / 16;
        }
        print_message("%u: %.2f\n", x, moved);
        assert_true(x < 56 ? moved < 0.55 : x >= 80 ? moved > 0.75 : true);
    }
    free(plain);
    free(s);
}

/* A hole between a near and a far wall is part of one or the other: the other view shows which. */
TEST(swept)
{
    enum { NEAR = 1000, FAR = 2000, FROM = 32, END = 64 };
    for (uint32_t truth = NEAR; truth <= FAR; truth += FAR - NEAR) {
        shot *s = shoot(FROM, END), *other = shoot(0, W);
        t3r_camera there = camera;
        uint64_t seed = 3;
        there.position_q32[0] = ((int64_t)8 * NEAR << 20) / W; /* 8 pixels of the near wall, of a step of 2^-12 */
        for (uint32_t i = 0; i < PIXELS; i++) {
            s->truth[i] = i % W < FROM ? NEAR : i % W < END ? truth : FAR;
            s->depth[i] = (uint16_t)(s->depth[i] == 0 ? 0 : s->truth[i]);
            s->colour[0][i] = s->colour[1][i] = s->colour[2][i] = (uint8_t)unit_between(&seed, 1, 255);
        }
        for (uint32_t pass = 0; pass < 2; pass++) { /* the near wall hides the far one */
            for (uint32_t i = 0; i < PIXELS; i++) {
                const uint32_t shift = s->truth[i] > NEAR ? 4 : 8;
                if ((shift == 8) == (pass == 1) && i % W >= shift) {
                    for (int c = 0; c < 3; c++) {
                        other->colour[c][i - shift] = s->colour[c][i];
                    }
                }
            }
        }
        fill(&s->view, &other->view, &there, work);
        assert_true(off(s) < 0.1);
        free(other);
        free(s);
    }
}

/* Another view that sees nothing of the surfaces changes nothing: beside them, far beside them, turned away. */
TEST(swept_in_vain)
{
    enum { BESIDE = 8, FAR_BESIDE = 8 * 25, PLACES = 8 }; /* the surfaces are within 1.6 units */
    shot *other = shoot(0, W), *plain = shoot(40, 60);
    fill(&plain->view, NULL, NULL, work);
    for (int place = 0; place <= PLACES; place++) {
        shot *s = shoot(40, 60);
        t3r_camera there = camera;
        if (place < PLACES) {
            const int64_t away = place / 4 == 0 ? BESIDE : FAR_BESIDE;
            there.position_q32[place / 2 % 2] = (place % 2 == 0 ? away : -away) * (INT64_C(1) << 32);
        } else {
            memcpy(there.rotation_q30, (const int32_t[]){0, 0, 1 << 30, 0}, sizeof there.rotation_q30);
        }
        fill(&s->view, &other->view, &there, work);
        assert_memory_equal(s->depth, plain->depth, sizeof s->depth);
        free(s);
    }
    free(plain);
    free(other);
}

/* Planes continue where no path leads: each step between stripes is long. */
TEST(beyond_all_paths)
{
    shot *s = shoot(24, W), *plain = shoot(24, W);
    for (uint32_t i = 0; i < PIXELS; i++) {
        s->colour[0][i] = s->colour[1][i] = s->colour[2][i] = i % 2 == 0 ? 1 : 255;
    }
    memcpy(plain->colour, s->colour, sizeof s->colour);
    uint8_t *room = aligned_alloc(64, T3R_SURROUNDINGS_BYTES_(W, H));
    t3r_fill_surroundings(&plain->view, T3R_FILLED, room);
    assert_int_equal(plain->depth[W - 1], 0);
    fill(&s->view, NULL, NULL, work);
    assert_true(off(s) < 0.1);
    free(room);
    free(plain);
    free(s);
}

/* With twice as many strips as there is room for planes, all room is used; without a match no plane is found. */
TEST(counted)
{
    shot *s = shoot(0, W);
    t3r_planes planes;
    t3r_search_planes(&s->view, work, &planes);
    assert_int_equal(planes.count, 0);
    for (uint32_t i = 0; i < PIXELS; i++) {
        s->depth[i] = (uint16_t)lround(1000 * pow(1.2, i % W * 16 / W));
        s->confidence[i] = 200;
    }
    t3r_search_planes(&s->view, work, &planes);
    assert_int_equal(planes.count, T3R_PLANES_MOST);
    free(s);
}

/* A patch with few samples gives its plane at once: everything is filled at its distance. */
TEST(of_a_patch)
{
    enum { WIDTH = 33, HEIGHT = 200, COUNT = WIDTH * HEIGHT, DEPTH = 1000 };
    uint16_t *depth = unit_array(COUNT, 2);
    uint8_t *confidence = unit_array(COUNT, 1), *grey = unit_array(COUNT, 1);
    memset(depth, 0, COUNT * sizeof *depth);
    memset(confidence, T3R_STEREO_NONE, COUNT);
    memset(grey, 100, COUNT);
    for (uint32_t y = 65; y < 72; y++) {
        for (uint32_t x = 13; x < 20; x++) {
            depth[y * WIDTH + x] = DEPTH;
            confidence[y * WIDTH + x] = 200;
        }
    }
    const t3r_view view = {.width = WIDTH,
                           .height = HEIGHT,
                           .colour = {grey, grey, grey},
                           .depth = depth,
                           .depth_unit_q40 = 1,
                           .match_confidence = confidence};
    uint8_t *room = aligned_alloc(64, T3R_PLANE_FILL_BYTES(WIDTH, HEIGHT));
    fill(&view, NULL, NULL, room);
    for (uint32_t i = 0; i < COUNT; i++) {
        assert_int_equal(depth[i], DEPTH);
    }
    free(room);
    free(depth);
    free(confidence);
    free(grey);
}

/* Black pixels are not filled; without planes the nearest surface is taken. */
TEST(left_alone)
{
    shot *s = shoot(50, W);
    for (int c = 0; c < 3; c++) {
        memset(s->colour[c] + PIXELS - W, 0, W);
    }
    fill(&s->view, NULL, NULL, work);
    for (uint32_t i = 0; i < PIXELS; i++) {
        assert_int_equal(s->depth[i] == 0, i >= PIXELS - W + 50);
        assert_int_equal(s->confidence[i] == T3R_STEREO_NONE, i >= PIXELS - W + 50);
    }
    free(s);
    s = shoot(0, W);
    s->depth[9] = 500;
    s->confidence[9] = 90;
    fill(&s->view, NULL, NULL, work);
    for (uint32_t i = 0; i < PIXELS; i++) {
        assert_int_equal(s->depth[i], 500);
    }
    free(s);
}

/* Any depths on views of any size: every depth is within its range, and repeated runs agree. */
TEST(anything)
{
    static const uint32_t sides[][2] = {{32, 32}, {33, 200}, {500, 40}, {64, 65}};
    uint64_t seed = 8;
    for (uint32_t turn = 0; turn < 40; turn++) {
        const uint32_t width = sides[turn % 4][0], height = sides[turn % 4][1];
        const size_t pixels = (size_t)width * height;
        uint16_t *depth[2] = {unit_array(pixels, 2), unit_array(pixels, 2)};
        uint8_t *confidence[2] = {unit_array(pixels, 1), unit_array(pixels, 1)}, *colour = unit_array(pixels, 1);
        const int64_t spread = INT64_C(1) << (turn % 17);
        for (size_t i = 0; i < pixels; i++) {
            const bool hole = (i % width / 8 + i / width / 8 + turn) % 3 == 0 && turn % 5 != 0;
            depth[0][i] =
                hole ? 0 : (uint16_t)unit_between(&seed, turn < 20 ? 1 : 65536 - spread, turn < 20 ? spread : 65535);
            confidence[0][i] = hole ? T3R_STEREO_NONE : (uint8_t)unit_between(&seed, 1, 255);
            depth[0][i] = depth[0][i] == 0 && !hole ? 1 : depth[0][i];
            colour[i] = (uint8_t)unit_random(&seed);
        }
        memcpy(depth[1], depth[0], pixels * 2);
        memcpy(confidence[1], confidence[0], pixels);
        uint8_t *room = aligned_alloc(64, T3R_PLANE_FILL_BYTES(width, height));
        for (int k = 0; k < 2; k++) {
            memset(room, 85 * k, T3R_PLANE_FILL_BYTES(width, height));
            const t3r_view view = {.width = width,
                                   .height = height,
                                   .colour = {colour, colour, colour},
                                   .depth = depth[k],
                                   .match_confidence = confidence[k],
                                   .depth_unit_q40 = UINT64_C(1) << (turn + 7)};
            fill(&view, NULL, NULL, room);
            for (size_t i = 0; i < pixels; i++) {
                assert_int_equal(depth[k][i] == 0, confidence[k][i] == T3R_STEREO_NONE);
            }
        }
        assert_memory_equal(depth[0], depth[1], pixels * 2);
        assert_memory_equal(confidence[0], confidence[1], pixels);
        free(room);
        for (int k = 0; k < 2; k++) {
            free(depth[k]);
            free(confidence[k]);
        }
        free(colour);
    }
}

/* Rows that end at the same distance as the other view's, at another distance, and nowhere near. */
TEST(outlines)
{
    enum { SIDE = 40, COUNT = 16, RIGHT = SIDE + COUNT - 1 };
    uint8_t left[SIDE], right[RIGHT], confidence[2][RIGHT];
    uint16_t disparity[2][RIGHT];
    for (int moved = 0; moved < 8; moved++) {
        memset(left, 90, sizeof left);
        memset(right, 90, sizeof right);
        memset(left, 0, 10);
        memset(right, 0,
               (size_t)(10 + COUNT - 1 - 5 + moved)); /* from end to end the disparity is 5, changed by `moved` */
        memset(confidence, 70, sizeof confidence);
        for (int i = 0; i < RIGHT; i++) {
            disparity[0][i] = disparity[1][i] = 5 << T3R_DISPARITY_BITS;
        }
        for (int i = 0; i < RIGHT; i++) { /* as the check for agreement leaves them */
            confidence[0][i] = i < SIDE && left[i] != 0 && right[i + COUNT - 1 - 5] != 0 ? 70 : 0;
            const int x = i - (COUNT - 1 - 5);
            confidence[1][i] = x >= 0 && x < SIDE && right[i] != 0 && left[x] != 0 ? 70 : 0;
        }
        const t3r_match match = {.width = SIDE,
                                 .height = 1,
                                 .disparities = COUNT,
                                 .luma = {left, right},
                                 .disparity = {disparity[0], disparity[1]},
                                 .confidence = {confidence[0], confidence[1]}};
        t3r_plane_outline(&match);
        for (int x = 0; x < SIDE; x++) {
            /* no confidence up to 16 pixels from the farther end, if the two ends are within 3 */
            const int shown = x >= 10 + moved, near = moved <= 3 && x - 10 + 1 < 16;
            assert_int_equal(confidence[0][x] != 0, shown && !near);
            assert_int_equal(confidence[1][x + COUNT - 1 - 5] != 0, shown && !near);
        }
    }
}
