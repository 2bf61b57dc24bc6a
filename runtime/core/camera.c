/* SPDX-License-Identifier: Apache-2.0 */
/* Cameras in fixed point. */
#include "camera.h"

#include <stdbool.h>

#include "fixed.h"

#define FOCAL_LEAST_Q16 (8 << 16)
#define PIXELS_MOST_Q16 (16384 << 16)
#define COMPONENT_MOST_Q30 (INT32_C(3) << 29) /* 1.5 */

static bool focal_ok(int32_t f_q16)
{
    return f_q16 >= FOCAL_LEAST_Q16 && f_q16 < PIXELS_MOST_Q16;
}

static bool centre_ok(int32_t c_q16)
{
    return c_q16 > -PIXELS_MOST_Q16 && c_q16 < PIXELS_MOST_Q16;
}

static uint64_t square(int32_t x)
{
    return (uint64_t)((int64_t)x * x);
}

/* Returns the squared norm, Q60. With every |component| <= 1.5 it is at most 9 x 2^60 and fits. */
static uint64_t norm2_q60(const int32_t q[4])
{
    return square(q[0]) + square(q[1]) + square(q[2]) + square(q[3]);
}

static bool rotation_ok(const int32_t q[4])
{
    for (uint32_t i = 0; i < 4; i++) {
        if (q[i] > COMPONENT_MOST_Q30 || q[i] < -COMPONENT_MOST_Q30) {
            return false;
        }
    }
    uint64_t norm2 = norm2_q60(q);
    return norm2 >= UINT64_C(1) << 58 && norm2 <= UINT64_C(9) << 58;
}

/* Whether the camera is for that size, or for any. */
static bool size_ok(const t3r_camera *camera, uint32_t width, uint32_t height)
{
    return (camera->width == width && camera->height == height) || (camera->width | camera->height) == 0;
}

t3r_status t3r_camera_check(const t3r_camera *camera, uint32_t width, uint32_t height)
{
    if (camera == NULL) {
        return T3R_ERR_ARGUMENT;
    }
    if (!size_ok(camera, width, height) || !focal_ok(camera->fx_q16) || !focal_ok(camera->fy_q16) ||
        !centre_ok(camera->cx_q16) || !centre_ok(camera->cy_q16) ||
        (uint32_t)camera->distortion >= T3R_DISTORTION_COUNT || !rotation_ok(camera->rotation_q30)) {
        return T3R_ERR_CAMERA;
    }
    for (uint32_t i = 0; i < 3; i++) {
        if (camera->position_q32[i] >= T3R_MAX_POSITION_Q32 || camera->position_q32[i] <= -T3R_MAX_POSITION_Q32) {
            return T3R_ERR_CAMERA;
        }
    }
    if (camera->distortion == T3R_DISTORTION_RADTAN) {
        for (uint32_t i = 2; i < 4; i++) {
            int32_t p = camera->distortion_q24[i];
            if (p >= T3R_MAX_TANGENTIAL_Q24 || p <= -T3R_MAX_TANGENTIAL_Q24) {
                return T3R_ERR_CAMERA;
            }
        }
    }
    return T3R_OK;
}

/* Returns numerator / norm2 in Q30, round-half-up, by long division; |numerator| <= norm2 < 2^62. */
static int32_t quotient_q30(int64_t numerator, uint64_t norm2)
{
    uint64_t rest = (uint64_t)t3r_abs64(numerator);
    uint32_t quotient = rest >= norm2;

    rest -= quotient != 0 ? norm2 : 0;
    for (uint32_t i = 0; i < 30; i++) {
        rest *= 2;
        uint32_t digit = rest >= norm2;
        rest -= digit != 0 ? norm2 : 0;
        quotient = quotient * 2 + digit;
    }
    rest *= 2;
    if (numerator < 0) {
        return -(int32_t)(quotient + (rest > norm2));
    }
    return (int32_t)(quotient + (rest >= norm2));
}

void t3r_camera_rotation(const int32_t quaternion_q30[4], int32_t rotation_q30[9])
{
    /* Products of two components: at most 2.25 x 2^60; each entry's numerator is at most norm2 <= 2.25 x 2^60 in
     * size, each partial sum below 2^63. */
    int64_t w = quaternion_q30[0], x = quaternion_q30[1], y = quaternion_q30[2], z = quaternion_q30[3];
    uint64_t n = norm2_q60(quaternion_q30);

    rotation_q30[0] = quotient_q30(w * w - y * y + (x * x - z * z), n);
    rotation_q30[1] = quotient_q30(2 * (x * y - w * z), n);
    rotation_q30[2] = quotient_q30(2 * (x * z + w * y), n);
    rotation_q30[3] = quotient_q30(2 * (x * y + w * z), n);
    rotation_q30[4] = quotient_q30(w * w - x * x + (y * y - z * z), n);
    rotation_q30[5] = quotient_q30(2 * (y * z - w * x), n);
    rotation_q30[6] = quotient_q30(2 * (x * z - w * y), n);
    rotation_q30[7] = quotient_q30(2 * (y * z + w * x), n);
    rotation_q30[8] = quotient_q30(w * w - x * x + (z * z - y * y), n);
}

static int32_t saturate32(int64_t x)
{
    return (int32_t)t3r_clamp64(x, INT32_MIN, INT32_MAX);
}

static int32_t resized_focal(int32_t f_q16, uint32_t from, uint32_t to)
{
    return saturate32(t3r_round_div64((int64_t)f_q16 * to, from));
}

/* Returns (c + 1/2) to / from - 1/2: the centre of the first pixel is 0, the image's edge -1/2. */
static int32_t resized_centre(int32_t c_q16, uint32_t from, uint32_t to)
{
    return saturate32(t3r_round_div64(((int64_t)c_q16 + 0x8000) * to, from) - 0x8000);
}

t3r_camera t3r_camera_resized(const t3r_camera *camera, uint32_t from_width, uint32_t from_height, uint32_t to_width,
                              uint32_t to_height)
{
    t3r_camera resized = *camera;

    resized.width = to_width;
    resized.height = to_height;
    resized.fx_q16 = resized_focal(camera->fx_q16, from_width, to_width);
    resized.fy_q16 = resized_focal(camera->fy_q16, from_height, to_height);
    resized.cx_q16 = resized_centre(camera->cx_q16, from_width, to_width);
    resized.cy_q16 = resized_centre(camera->cy_q16, from_height, to_height);
    return resized;
}
