/* SPDX-License-Identifier: Apache-2.0 */
/* Cameras in fixed point. */
#include "camera.h"

#include "camera_checks.h"
#include "fixed.h"

t3r_status t3r_camera_check(const t3r_camera *camera, uint32_t width, uint32_t height)
{
    return camera == NULL ? T3R_ERR_ARGUMENT : t3r_camera_checks(camera, width, height, NULL);
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
    uint64_t n = t3r_norm2_q60(quaternion_q30);

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
