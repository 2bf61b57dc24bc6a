/* SPDX-License-Identifier: Apache-2.0 */
/* Rectification: rows and distances against double precision, the rows' pictures, refusals. */
#include "unit/unit.h"

#include "core/camera.h"
#include "stereo/match.h"
#include "stereo/rectify.h"

enum { W = 96, H = 80, D = 32 };

static t3r_camera camera_at(double x, double y, double z, const double q[4], double focal)
{
    t3r_camera c = {.fx_q16 = (int32_t)lround(focal * 65536),
                    .fy_q16 = (int32_t)lround(focal * 65536),
                    .cx_q16 = (W - 1) << 15,
                    .cy_q16 = (H - 1) << 15,
                    .position_q32 = {llround(x * 4294967296.0), llround(y * 4294967296.0), llround(z * 4294967296.0)}};
    for (int i = 0; i < 4; i++) {
        c.rotation_q30[i] = (int32_t)lround(q[i] * (1 << 30));
    }
    return c;
}

static const double straight[4] = {1, 0, 0, 0};

/* Makes a turn of `degrees` about an axis */
static void turned(double degrees, double x, double y, double z, double q[4])
{
    const double half = degrees * 3.14159265358979 / 360, length = sqrt(x * x + y * y + z * z);
    q[0] = cos(half);
    q[1] = sin(half) * x / length;
    q[2] = sin(half) * y / length;
    q[3] = sin(half) * z / length;
}

/* Projects a point into a camera: pixel and distance along z; returns 0 if the point is behind the camera. */
static int sees(const t3r_camera *c, const double point[3], double pixel[2], double *z)
{
    int32_t r[9];
    double p[3], v[3];
    t3r_camera_rotation(c->rotation_q30, r);
    for (int i = 0; i < 3; i++) {
        p[i] = point[i] - (double)c->position_q32[i] / 4294967296.0;
    }
    for (int i = 0; i < 3; i++) {
        v[i] = (r[i] * p[0] + r[3 + i] * p[1] + r[6 + i] * p[2]) / (1 << 30);
    }
    *z = v[2];
    pixel[0] = v[0] / v[2] * c->fx_q16 / 65536 + c->cx_q16 / 65536.0;
    pixel[1] = v[1] / v[2] * c->fy_q16 / 65536 + c->cy_q16 / 65536.0;
    return v[2] > 0 && pixel[0] >= 0 && pixel[1] >= 0 && pixel[0] <= W - 1 && pixel[1] <= H - 1;
}

static int64_t distance_q24(const t3r_column *a, const t3r_column *b)
{
    return ((int64_t)a->a_q24 * b->b_q24 - (int64_t)b->a_q24 * a->b_q24) >> 24;
}

/* Checks that every point seen by both is in one row, and that its columns give its distance. Returns the number of
 * points. */
static int check_points(const t3r_camera *first, const t3r_camera *second, const t3r_rectification *rect,
                        uint64_t *seed)
{
    int checked = 0;
    double base = 0;
    for (int i = 0; i < 3; i++) {
        const double d = (double)(second->position_q32[i] - first->position_q32[i]) / 4294967296.0;
        base += d * d;
    }
    base = sqrt(base);
    for (int n = 0; n < 4000; n++) {
        double point[3], pixel[2][2], z[2];
        for (int i = 0; i < 3; i++) {
            point[i] = (double)unit_between(seed, -4000, 4000) / 1000;
        }
        if (!sees(first, point, pixel[0], &z[0]) || !sees(second, point, pixel[1], &z[1])) {
            continue;
        }
        int32_t place[2][2], across[2];
        int both = 1;
        for (uint32_t i = 0; i < 2; i++) {
            both &= t3r_rectified_place(rect, i, (int32_t)lround(pixel[i][0] * 65536),
                                        (int32_t)lround(pixel[i][1] * 65536), place[i], &across[i]);
        }
        if (!both) {
            continue;
        }
        /* polar rows wrap around: they end where they begin, 8 units on */
        double rows = (place[0][1] - place[1][1]) / 65536.0, turn = 8.0 * rect->scale_q16[1] / 65536;
        rows = fabs(rows) > turn / 2 ? fabs(rows) - turn : rows;
        assert_true(fabs(rows) < 0.02);
        assert_true(place[0][0] > place[1][0] - 400);
        const t3r_column a = t3r_rectified_column(rect, place[0][0]), b = t3r_rectified_column(rect, place[1][0]);
        const double apart = (double)distance_q24(&a, &b) / (1 << 24);
        if (place[0][0] - place[1][0] < 65536 || a.b_q24 < 1 << 20 || b.b_q24 < 1 << 20) {
            continue; /* too far, or too near the epipole, to determine the distance */
        }
        const double ab = (double)a.b_q24 / (1 << 24) * b.b_q24 / (1 << 24);
        for (int i = 0; i < 2; i++) {
            const double found = base * ab / apart / ((double)across[i] / (1 << 24));
            assert_true(fabs(found / z[i] - 1) < 0.01);
        }
        checked++;
    }
    return checked;
}

/* Checks that planes are no larger than the macros say. */
static void check_size(const t3r_rectification *rect, uint32_t width, uint32_t height, uint32_t disparities)
{
    const size_t side = T3R_RECTIFIED_SIDE(width, height);
    assert_true(rect->width >= T3R_RECTIFIED_LEAST && rect->height >= T3R_RECTIFIED_LEAST);
    assert_true((size_t)rect->width * rect->height <= side * side);
    assert_true((size_t)(rect->width + disparities) * rect->height <= side * (side + disparities));
    for (uint32_t paths = 4; paths <= 8; paths += 4) {
        assert_true(T3R_MATCH_WORK_BYTES(rect->width, rect->height, disparities, paths) <=
                    T3R_MATCH_WORK_BYTES(side, side, disparities, paths));
    }
}

TEST(geometry)
{
    static const struct {
        double x, y, z, degrees, ax, ay, az;
        int polar;
    } pairs[] = {
        {0.3, 0, 0, 0, 0, 1, 0, 0},     {-0.3, 0, 0, 0, 0, 1, 0, 0},     {0, 0.3, 0, 0, 1, 0, 0, 0},
        {0.2, -0.2, 0, 0, 1, 0, 0, 0},  {0.4, 0, 0.05, -14, 0, 1, 0, 0}, {0.1, 0.4, 0, 17, 1, 0.2, 0.3, 0},
        {0.3, 0, 0, 90, 0, 0, 1, 0},    {0, 0, 0.4, 0, 0, 1, 0, 1},      {0.05, -0.04, 0.4, 5, 1, 1, 1, 1},
        {0.2, 0, 0.35, -8, 0, 1, 0, 1}, {0.1, 0.1, -0.4, 3, 0, 0, 1, 1}, {0.3, 0.1, 0.25, 20, 0.1, 0.2, 1, 1},
    };
    uint64_t seed = 77;
    for (size_t i = 0; i < sizeof pairs / sizeof *pairs; i++) {
        double q[4];
        t3r_rectification rect;
        turned(pairs[i].degrees, pairs[i].ax, pairs[i].ay, pairs[i].az, q);
        const t3r_camera first = camera_at(1, -2, 0.5, straight, 90);
        const t3r_camera second = camera_at(1 + pairs[i].x, -2 + pairs[i].y, 0.5 + pairs[i].z, q, 90);
        assert_int_equal(t3r_rectify(&first, &second, W, H, D, &rect), T3R_PAIR_OK);
        assert_int_equal(rect.polar, pairs[i].polar);
        check_size(&rect, W, H, D);
        assert_true(check_points(&first, &second, &rect, &seed) > 40);
    }
}

/* Cameras side by side: the plane is the picture, pixel by pixel. */
TEST(identity)
{
    uint64_t seed = 4;
    t3r_rectification rect;
    uint8_t *luma = unit_array(W * H, 1), *out = unit_array(W, 1);
    for (int i = 0; i < W * H; i++) {
        luma[i] = (uint8_t)unit_between(&seed, 1, 255);
    }
    const t3r_camera first = camera_at(0, 0, 0, straight, 450), second = camera_at(0.4, 0, 0, straight, 450);
    assert_int_equal(t3r_rectify(&first, &second, W, H, D, &rect), T3R_PAIR_OK);
    assert_false(rect.polar);
    assert_int_equal(rect.width, W);
    assert_int_equal(rect.height, H);
    for (uint32_t side = 0; side < 2; side++) {
        for (uint32_t y = 0; y < H; y++) {
            const t3r_share row = {y, y + 1};
            t3r_rectified_rows(&t3r_kernels_c, &rect, side, luma, rect.first_q16[0], row, W, out);
            assert_memory_equal(out, luma + y * W, W);
            t3r_rectified_rows(&t3r_kernels_c, &rect, side, luma, rect.first_q16[0] - (5 << 16), row, W, out);
            assert_memory_equal(out + 5, luma + y * W, W - 5);
            for (int x = 0; x < 5; x++) {
                assert_int_equal(out[x], 0);
            }
        }
    }
    free(luma);
    free(out);
}

/* A plane's pixels are the view's pixels at t3r_rectified_place(): checked on a slope of grey. */
TEST(sampled)
{
    for (int kind = 0; kind < 3; kind++) {
        double q[4];
        t3r_rectification rect;
        uint8_t *luma = unit_array(W * H, 1);
        turned(11, 0.3, 1, 0.2, q);
        const t3r_camera first = camera_at(0, 0, 0, straight, 90);
        const t3r_camera second = kind == 0   ? camera_at(-0.2, 0.1, 0, q, 90)
                                  : kind == 1 ? camera_at(0.02, -0.03, 0.3, q, 90)
                                              : camera_at(0.02, 0.3, 0.05, q, 90);
        assert_int_equal(t3r_rectify(&first, &second, W, H, D, &rect), T3R_PAIR_OK);
        for (int along = 0; along < 2; along++) {
            for (int i = 0; i < W * H; i++) {
                luma[i] = (uint8_t)(2 * (along ? i / W : i % W) + 20);
            }
            uint8_t *plane = unit_array((size_t)rect.width * rect.height, 1);
            t3r_rectified_rows(&t3r_kernels_c, &rect, 0, luma, rect.first_q16[0], (t3r_share){0, rect.height},
                               rect.width, plane);
            int looked = 0;
            for (int v = 1; v < H - 1; v++) {
                for (int u = 1; u < W - 1; u++) {
                    int32_t place[2], across;
                    if (!t3r_rectified_place(&rect, 0, u << 16, v << 16, place, &across)) {
                        continue;
                    }
                    const double x = (place[0] - rect.first_q16[0]) / 65536.0, y = place[1] / 65536.0;
                    const int left = (int)floor(x), top = (int)floor(y);
                    if (left < 0 || top < 0 || left + 1 >= (int)rect.width || top + 1 >= (int)rect.height) {
                        continue;
                    }
                    const uint8_t *p = plane + top * (int)rect.width + left;
                    const double fx = x - left, fy = y - top;
                    const uint8_t *below = p + rect.width;
                    if (p[0] == 0 || p[1] == 0 || below[0] == 0 || below[1] == 0) {
                        continue;
                    }
                    const double got =
                        (1 - fy) * ((1 - fx) * p[0] + fx * p[1]) + fy * ((1 - fx) * below[0] + fx * below[1]);
                    /* half a level of rounding; and the row's bending within a pixel, most near the epipole */
                    assert_true(fabs(got - 2 * (along ? v : u) - 20) < (rect.polar ? 2.5 : 1));
                    looked++;
                }
            }
            assert_true(looked > W * H / 3);
            free(plane);
        }
        free(luma);
    }
}

TEST(refused)
{
    double q[4], away[4], behind[4];
    t3r_rectification rect;
    turned(10, 0, 1, 0, q);
    turned(80, 0, 1, 0, away);
    turned(180, 0, 1, 0, behind);
    const t3r_camera here = camera_at(1, 2, 3, straight, 90);
    const t3r_camera same = here, rotated = camera_at(1, 2, 3, q, 90);
    const t3r_camera outwards_right = camera_at(1.4, 2, 3, away, 90);
    const t3r_camera back = camera_at(1.5, 2, 3, behind, 90);
    t3r_camera near = here;
    near.position_q32[1] += 4095;
    assert_int_equal(t3r_rectify(&here, &same, W, H, D, &rect), T3R_PAIR_NO_BASELINE);
    assert_int_equal(t3r_rectify(&here, &near, W, H, D, &rect), T3R_PAIR_NO_BASELINE);
    assert_int_equal(t3r_rectify(&here, &rotated, W, H, D, &rect), T3R_PAIR_ROTATION);
    assert_int_equal(t3r_rectify(&here, &back, W, H, D, &rect), T3R_PAIR_OVERLAP);
    assert_int_equal(t3r_rectify(&here, &outwards_right, W, H, D, &rect), T3R_PAIR_OVERLAP);

    for (int pair = 0; pair < T3R_PAIR_COUNT; pair++) {
        assert_string_not_equal(t3r_pair_text((t3r_pair)pair), "unknown");
    }
    assert_string_equal(t3r_pair_text(T3R_PAIR_COUNT), "unknown");
}

/* Rays without a place: far to a plane's side, along the baseline, or steeper than the limit. */
TEST(nowhere)
{
    t3r_rectification rect;
    int32_t place[2], across;
    const t3r_camera first = camera_at(0, 0, 0, straight, 450), beside = camera_at(0.3, 0, 0, straight, 450);
    assert_int_equal(t3r_rectify(&first, &beside, W, H, D, &rect), T3R_PAIR_OK);
    assert_false(rect.polar);
    const int32_t middle[2] = {(W - 1) << 15, (H - 1) << 15};
    assert_true(t3r_rectified_place(&rect, 0, middle[0], middle[1], place, &across));
    for (int sign = -1; sign <= 1; sign += 2) {
        const int32_t near = sign * (450 * 39 / 10) * 65536, far = sign * (450 * 41 / 10) * 65536; /* 4 is the most */
        assert_true(t3r_rectified_place(&rect, 0, middle[0] + near, middle[1], place, &across));
        assert_false(t3r_rectified_place(&rect, 0, middle[0] + far, middle[1], place, &across));
        assert_true(t3r_rectified_place(&rect, 0, middle[0], middle[1] + near, place, &across));
        assert_false(t3r_rectified_place(&rect, 0, middle[0], middle[1] + far, place, &across));
    }
    const t3r_camera here = camera_at(0, 0, 0, straight, 90), ahead = camera_at(0, 0, 1, straight, 90);
    assert_int_equal(t3r_rectify(&here, &ahead, W, H, D, &rect), T3R_PAIR_OK);
    assert_true(rect.polar);
    assert_false(t3r_rectified_place(&rect, 0, middle[0], middle[1], place, &across)); /* the epipole itself */
    assert_true(t3r_rectified_place(&rect, 0, middle[0] + (10 << 16), middle[1], place, &across));

    t3r_view_columns columns;
    rect.view[0].fx_q16 = 8 << 16;
    for (int32_t centre = -500; centre <= 500; centre += 1000) { /* rays up to 16 to the side of 1 ahead */
        rect.view[0].cx_q16 = centre * (1 << 16);
        t3r_view_columns_of(&rect, 0, 40, 1, 3, &columns);
        for (int i = 0; i < 3; i++) {
            assert_int_equal(columns.x_q24[i], (centre < 0 ? 16 : -16) * (1 << 24));
        }
        assert_int_equal(columns.x_q24[3], 0);
    }
}

/* A camera whose picture is far below its axis, and which leans the other way: rays steeper than 4, still in a plane.
 */
TEST(steep_in_a_plane)
{
    enum { WIDE = 400, TALL = 520, FOCAL = 580 };
    for (int sign = -1; sign <= 1; sign += 2) {
        double one[4], other[4];
        t3r_rectification rect;
        turned(35 * sign, 1, 0, 0, one);
        turned(-35 * sign, 1, 0, 0, other);
        t3r_camera first = camera_at(0, 0, 0, one, FOCAL), second = camera_at(0.3, 0, 0, other, FOCAL);
        first.cx_q16 = second.cx_q16 = (WIDE - 1) << 15;
        second.cy_q16 = (TALL - 1) << 15;
        first.cy_q16 = second.cy_q16 - sign * (FOCAL * 9 / 2) * 65536;
        assert_int_equal(t3r_rectify(&first, &second, WIDE, TALL, D, &rect), T3R_PAIR_OK);
        assert_false(rect.polar);
        uint32_t steep = 0;
        for (uint32_t v = 0; v < TALL; v++) {
            t3r_ray_places places;
            t3r_view_columns columns;
            t3r_view_columns_of(&rect, 0, 8, 2, 60, &columns);
            t3r_rectified_places(&t3r_kernels_c, &rect, 0, &columns, v, &places);
            for (int i = 0; i < 60; i++) {
                int32_t place[2] = {0, 0}, across = 0;
                assert_true(t3r_rectified_place(&rect, 0, (8 + 2 * i) << 16, (int32_t)v << 16, place, &across));
                assert_int_equal(places.x_q16[i], place[0]);
                assert_int_equal(places.y_q16[i], place[1]);
                assert_int_equal(places.z_q24[i], across);
            }
            steep += abs(((int32_t)v << 16) - first.cy_q16) > 4 * FOCAL * 65536;
        }
        assert_in_range(steep, TALL / 2, TALL);
        /* 86 degrees off its axis: on one side in the plane, on the other behind it */
        int32_t place[2], across;
        const int32_t aside = sign * 15 * FOCAL * 65536;
        assert_true(t3r_rectified_place(&rect, 0, 40 << 16, first.cy_q16 + aside, place, &across));
        assert_false(t3r_rectified_place(&rect, 0, 40 << 16, first.cy_q16 - aside, place, &across));
    }
}

/* Any camera that passes its check gives a result, sizes within their bounds, and rows that can be drawn. */
TEST(anything)
{
    uint64_t seed = 12;
    uint8_t luma[48 * 40], row[512];
    memset(luma, 90, sizeof luma);
    int matched = 0;
    for (int turn = 0; turn < 20000; turn++) {
        t3r_camera c[2];
        t3r_rectification rect;
        const int far = unit_random(&seed) % 4 == 0;
        for (int i = 0; i < 2; i++) {
            c[i] = (t3r_camera){
                .fx_q16 = (int32_t)unit_between(&seed, 8 << 16, turn % 3 == 0 ? (16384 << 16) - 1 : 40 << 16),
                .fy_q16 = (int32_t)unit_between(&seed, 8 << 16, turn % 3 == 0 ? (16384 << 16) - 1 : 40 << 16),
                .cx_q16 = (int32_t)unit_between(&seed, far ? -(16383 << 16) : 0, far ? 16383 << 16 : 48 << 16),
                .cy_q16 = (int32_t)unit_between(&seed, far ? -(16383 << 16) : 0, far ? 16383 << 16 : 40 << 16)};
            for (int k = 0; k < 3; k++) {
                const int64_t most = INT64_C(1) << unit_between(&seed, 0, 61);
                c[i].position_q32[k] = unit_between(&seed, -most, most);
            }
            const int64_t spread = INT64_C(1) << unit_between(&seed, 20, 30);
            c[i].rotation_q30[0] = 1 << 30;
            for (int k = 1; k < 4; k++) {
                c[i].rotation_q30[k] = (int32_t)unit_between(&seed, -spread / 2, spread / 2);
            }
            assert_int_equal(t3r_camera_check(&c[i], 48, 40), T3R_OK);
        }
        const t3r_pair pair = t3r_rectify(&c[0], &c[1], 48, 40, 16, &rect);
        if (pair != T3R_PAIR_OK) {
            continue;
        }
        matched++;
        check_size(&rect, 48, 40, 16);
        assert_true(rect.least_disparity >= 0 && rect.most_disparity > rect.least_disparity);
        for (uint32_t side = 0; side < 2; side++) {
            const uint32_t y = (uint32_t)unit_random(&seed) % rect.height, v = (uint32_t)unit_random(&seed) % 40;
            t3r_rectified_rows(&t3r_kernels_c, &rect, side, luma, rect.first_q16[0], (t3r_share){y, y + 1}, rect.width,
                               row);
            t3r_ray_places places;
            t3r_view_columns columns;
            t3r_view_columns_of(&rect, side, 3, 1, 45, &columns);
            t3r_rectified_places(&t3r_kernels_c, &rect, side, &columns, v, &places);
            for (int i = 0; i < 45; i++) {
                int32_t place[2] = {0, 0}, across = 0;
                (void)t3r_rectified_place(&rect, side, (3 + i) << 16, (int32_t)v << 16, place, &across);
                assert_int_equal(places.x_q16[i], place[0]);
                assert_int_equal(places.y_q16[i], place[1]);
                assert_int_equal(places.z_q24[i], across);
            }
        }
    }
    print_message("%d of 20000 can be matched\n", matched);
    assert_true(matched > 200);
}

/* Planes around the direction of motion are tall: up to the limit of the work memory, in pictures of every size. */
TEST(tall)
{
    static const uint32_t sides[] = {90, 100, 300, 408, 412, 1200, 1630, 1645, 2400, 4096};
    for (size_t i = 0; i < sizeof sides / sizeof sides[0]; i++) {
        const int32_t side = (int32_t)sides[i];
        for (int wide = 1; wide <= 2; wide++) {
            t3r_rectification rect;
            t3r_camera here = camera_at(0, 0, 0, straight, side / (double)wide + 8);
            here.cx_q16 = here.cy_q16 = (side - 1) << 15;
            t3r_camera ahead = here;
            ahead.position_q32[2] = INT64_C(1) << 30;
            assert_int_equal(t3r_rectify(&here, &ahead, sides[i], sides[i], D, &rect), T3R_PAIR_OK);
            assert_true(rect.polar && rect.height > rect.width);
            check_size(&rect, sides[i], sides[i], D);
        }
    }
}
