/* SPDX-License-Identifier: Apache-2.0 */
/* Cameras: refusals, rotation matrices and changes of size against double. */
#include "unit/unit.h"

#include "core/camera.h"
#include "core/fault.h"

enum { W = 128, H = 96 };

#define Q16(x) ((int32_t)lround((x)*65536.0))

static t3r_camera plain_camera(void)
{
    return (t3r_camera){.width = W,
                        .height = H,
                        .fx_q16 = Q16(100),
                        .fy_q16 = Q16(110),
                        .cx_q16 = Q16(63.5),
                        .cy_q16 = Q16(47.5),
                        .rotation_q30 = {1 << 30}};
}

TEST(ranges)
{
    t3r_camera camera = plain_camera();
    assert_int_equal(t3r_camera_check(&camera, W, H), T3R_OK);
    assert_int_equal(t3r_camera_check(NULL, W, H), T3R_ERR_ARGUMENT);
#define GIVES(status, change)                                                                                          \
    do {                                                                                                               \
        camera = plain_camera();                                                                                       \
        change;                                                                                                        \
        assert_int_equal(t3r_camera_check(&camera, W, H), status);                                                     \
    } while (0)
    GIVES(T3R_OK, camera.width = camera.height = 0); /* any size */
    GIVES(T3R_ERR_CAMERA, camera.width = 0);
    GIVES(T3R_ERR_CAMERA, camera.height = 0);
    GIVES(T3R_ERR_CAMERA, camera.width = W + 1);
    GIVES(T3R_ERR_CAMERA, camera.height = 2 * H; camera.width = 2 * W);
    GIVES(T3R_ERR_CAMERA, camera.width = H; camera.height = W);
    GIVES(T3R_OK, camera.fx_q16 = 8 << 16);
    GIVES(T3R_ERR_CAMERA, camera.fx_q16 = (8 << 16) - 1);
    GIVES(T3R_ERR_CAMERA, camera.fy_q16 = 16384 << 16);
    GIVES(T3R_ERR_CAMERA, camera.fy_q16 = INT32_MIN);
    GIVES(T3R_OK, camera.cx_q16 = -(16384 << 16) + 1);
    GIVES(T3R_ERR_CAMERA, camera.cx_q16 = -(16384 << 16));
    GIVES(T3R_ERR_CAMERA, camera.cy_q16 = INT32_MAX);
    GIVES(T3R_ERR_CAMERA, camera.distortion = T3R_DISTORTION_COUNT);
    GIVES(T3R_ERR_CAMERA, camera.distortion = (t3r_distortion)-1);
    GIVES(T3R_ERR_CAMERA, camera.position_q32[1] = INT64_MIN);
    GIVES(T3R_ERR_CAMERA, camera.position_q32[2] = T3R_MAX_POSITION_Q32);
    GIVES(T3R_OK, camera.position_q32[0] = 1 - T3R_MAX_POSITION_Q32);
    GIVES(T3R_OK, camera.rotation_q30[0] = 1 << 29);
    GIVES(T3R_ERR_CAMERA, camera.rotation_q30[0] = (1 << 29) - 1);
    GIVES(T3R_OK, camera.rotation_q30[0] = 3 << 29);
    GIVES(T3R_ERR_CAMERA, camera.rotation_q30[0] = (3 << 29) + 1);
    GIVES(T3R_ERR_CAMERA, camera.rotation_q30[0] = 0);
    GIVES(T3R_ERR_CAMERA, memset(camera.rotation_q30, 0x80, sizeof camera.rotation_q30));
    GIVES(T3R_ERR_CAMERA, camera.rotation_q30[1] = INT32_MIN);
    GIVES(T3R_ERR_CAMERA, for (int i = 0; i < 4; i++) camera.rotation_q30[i] = INT32_MIN);
    GIVES(T3R_ERR_CAMERA, camera.rotation_q30[1] = camera.rotation_q30[2] = camera.rotation_q30[3] = 1 << 30);
    GIVES(T3R_ERR_CAMERA, camera.rotation_q30[0] = 3 << 29; camera.rotation_q30[3] = 1 << 10);
    GIVES(T3R_OK, camera.distortion_q24[2] = INT32_MAX);
    GIVES(T3R_ERR_CAMERA, camera.distortion = T3R_DISTORTION_RADTAN; camera.distortion_q24[3] = INT32_MIN);
#undef GIVES
}

static void both_sides(const t3r_camera *within, const t3r_camera *beyond)
{
    assert_int_equal(t3r_camera_check(within, W, H), T3R_OK);
    assert_int_equal(t3r_camera_check(beyond, W, H), T3R_ERR_CAMERA);
}

TEST(bounds)
{
    const int32_t pixels = 16384 << 16, component = 3 << 29;
#define BOUND(field, last, first)                                                                                      \
    do {                                                                                                               \
        t3r_camera within = plain_camera(), beyond = plain_camera();                                                   \
        within.distortion = beyond.distortion = T3R_DISTORTION_RADTAN;                                                 \
        within.field = (last);                                                                                         \
        beyond.field = (first);                                                                                        \
        both_sides(&within, &beyond);                                                                                  \
    } while (0)
#define BOTH_BOUNDS(field, last)                                                                                       \
    do {                                                                                                               \
        BOUND(field, last, (last) + 1);                                                                                \
        BOUND(field, -(last), -(last)-1);                                                                              \
    } while (0)
    BOUND(fx_q16, 8 << 16, (8 << 16) - 1);
    BOUND(fy_q16, 8 << 16, (8 << 16) - 1);
    BOUND(fx_q16, pixels - 1, pixels);
    BOUND(fy_q16, pixels - 1, pixels);
    BOTH_BOUNDS(cx_q16, pixels - 1);
    BOTH_BOUNDS(cy_q16, pixels - 1);
    for (int i = 0; i < 3; i++) {
        BOTH_BOUNDS(position_q32[i], T3R_MAX_POSITION_Q32 - 1);
    }
    for (int i = 2; i < 4; i++) {
        BOTH_BOUNDS(distortion_q24[i], T3R_MAX_TANGENTIAL_Q24 - 1);
    }
#undef BOTH_BOUNDS
#undef BOUND
    for (int i = 0; i < 8; i++) { /* a single component, of either sign */
        t3r_camera within = plain_camera(), beyond = plain_camera();
        within.rotation_q30[0] = beyond.rotation_q30[0] = 0;
        within.rotation_q30[i / 2] = i % 2 == 0 ? component : -component;
        beyond.rotation_q30[i / 2] = i % 2 == 0 ? component + 1 : -component - 1;
        both_sides(&within, &beyond);
    }
    t3r_camera camera = plain_camera();
    camera.distortion = T3R_DISTORTION_RADTAN;
    camera.distortion_q24[0] = INT32_MIN;
    camera.distortion_q24[1] = camera.distortion_q24[4] = INT32_MAX;
    assert_int_equal(t3r_camera_check(&camera, W, H), T3R_OK);
}

/* A sentence has the values that are refused, and the bounds. */
TEST(sentences)
{
    const int64_t pixels = (16384 << 16) - 1;
#define NAMES(change, first, second, third, fourth)                                                                    \
    do {                                                                                                               \
        t3r_camera camera = plain_camera();                                                                            \
        t3r_fault fault = {0};                                                                                         \
        change;                                                                                                        \
        assert_int_equal(t3r_camera_fault(&camera, W, H, &fault), T3R_ERR_CAMERA);                                     \
        const int64_t numbers[4] = {first, second, third, fourth};                                                     \
        assert_memory_equal(fault.number, numbers, sizeof numbers);                                                    \
    } while (0)
    NAMES(camera.width = 7, 7, H, W, H);
    NAMES(camera.fx_q16 = 5, 5, 8 << 16, pixels, 0);
    NAMES(camera.fy_q16 = 6, 6, 8 << 16, pixels, 0);
    NAMES(camera.cx_q16 = INT32_MAX, INT32_MAX, -pixels, pixels, 0);
    NAMES(camera.cy_q16 = INT32_MIN, INT32_MIN, -pixels, pixels, 0);
    NAMES(camera.distortion = (t3r_distortion)77, 77, T3R_DISTORTION_COUNT - 1, 0, 0);
    NAMES(memcpy(camera.rotation_q30, ((int32_t[]){1, 2, 3, 4}), 16), 1, 2, 3, 4);
    NAMES(camera.position_q32[2] = INT64_MIN, 2, INT64_MIN, T3R_MAX_POSITION_Q32, T3R_MAX_POSITION_Q32);
    NAMES(camera.distortion = T3R_DISTORTION_RADTAN;
          camera.distortion_q24[3] = INT32_MAX, 3, INT32_MAX, T3R_MAX_TANGENTIAL_Q24, T3R_MAX_TANGENTIAL_Q24);
#undef NAMES
}

TEST(rotation)
{
    uint64_t seed = 2;
    double worst = 0;
    for (int turn = 0; turn < 20000; turn++) {
        int32_t quaternion[4];
        int32_t matrix[9];
        int64_t most = turn % 2 == 0 ? (3 << 29) : (1 << 30);
        for (int i = 0; i < 4; i++) {
            quaternion[i] = turn % 5 == 4 && i == turn % 4 ? 0 : (int32_t)unit_between(&seed, -most, most);
        }
        t3r_camera camera = plain_camera();
        memcpy(camera.rotation_q30, quaternion, sizeof quaternion);
        if (t3r_camera_check(&camera, W, H) != T3R_OK) {
            continue;
        }
        t3r_camera_rotation(quaternion, matrix);
        double w = quaternion[0], x = quaternion[1], y = quaternion[2], z = quaternion[3];
        double s = 2 / (w * w + x * x + y * y + z * z);
        const double exact[9] = {1 - s * (y * y + z * z), s * (x * y - w * z),     s * (x * z + w * y),
                                 s * (x * y + w * z),     1 - s * (x * x + z * z), s * (y * z - w * x),
                                 s * (x * z - w * y),     s * (y * z + w * x),     1 - s * (x * x + y * y)};
        for (int i = 0; i < 9; i++) {
            worst = fmax(worst, fabs(matrix[i] - exact[i] * (1 << 30)));
        }
    }
    assert_true(worst <= 0.5001);
    const int32_t half_turn[4] = {0, 3 << 29, 0, 0};
    int32_t matrix[9];
    t3r_camera_rotation(half_turn, matrix);
    const int32_t expected[9] = {1 << 30, 0, 0, 0, -(1 << 30), 0, 0, 0, -(1 << 30)};
    assert_memory_equal(matrix, expected, sizeof matrix);
}

TEST(resized)
{
    uint64_t seed = 4;
    for (int turn = 0; turn < 2000; turn++) {
        t3r_camera camera = plain_camera();
        uint32_t from_w = (uint32_t)unit_between(&seed, 2, 4096), from_h = (uint32_t)unit_between(&seed, 2, 4096);
        uint32_t to_w = (uint32_t)unit_between(&seed, 8, from_w + 8),
                 to_h = (uint32_t)unit_between(&seed, 8, from_h + 8);
        camera.fx_q16 = (int32_t)unit_between(&seed, 8 << 16, 2000 << 16);
        camera.cx_q16 = (int32_t)unit_between(&seed, -(2000 << 16), 2000 << 16);
        camera.cy_q16 = (int32_t)unit_between(&seed, -(2000 << 16), 2000 << 16);
        t3r_camera got = t3r_camera_resized(&camera, from_w, from_h, to_w, to_h);
        double sx = (double)to_w / from_w, sy = (double)to_h / from_h;
        assert_true(fabs(got.fx_q16 - camera.fx_q16 * sx) <= 0.5001);
        assert_true(fabs(got.fy_q16 - camera.fy_q16 * sy) <= 0.5001);
        assert_true(fabs(got.cx_q16 - ((camera.cx_q16 + 32768.0) * sx - 32768)) <= 0.5001);
        assert_true(fabs(got.cy_q16 - ((camera.cy_q16 + 32768.0) * sy - 32768)) <= 0.5001);
        assert_true(got.width == to_w && got.height == to_h);
        got = t3r_camera_resized(&camera, W, H, W, H);
        assert_memory_equal(&got, &camera, sizeof got);
    }
    t3r_camera camera = plain_camera();
    camera.fx_q16 = (16384 << 16) - 1;
    camera.cx_q16 = -(16384 << 16) + 1;
    t3r_camera got = t3r_camera_resized(&camera, 2, 2, 4096, 4096);
    assert_int_equal(got.fx_q16, INT32_MAX);
    assert_int_equal(got.cx_q16, INT32_MIN);
    assert_int_equal(t3r_camera_check(&got, 4096, 4096), T3R_ERR_CAMERA);
}
