/* SPDX-License-Identifier: Apache-2.0 */
#include "capture/capture_camera.h"

#include <math.h>
#include <string.h>

#include "messages/fixed_double.h"

t3r_recorded_camera capture_camera_recorded(const t3r_capture_frame *frame)
{
    const t3r_camera *camera = &frame->camera;
    t3r_recorded_camera c = {.width = frame->frame.width, .height = frame->frame.height};
    if (frame->has_intrinsics) {
        c.fx = camera->fx_q16 * 0x1p-16;
        c.fy = camera->fy_q16 * 0x1p-16;
        c.cx = camera->cx_q16 * 0x1p-16;
        c.cy = camera->cy_q16 * 0x1p-16;
        c.distortion = camera->distortion;
        for (int i = 0; i < 5; i++) {
            c.coefficients[i] = camera->distortion_q24[i] * 0x1p-24;
        }
    }
    if (frame->has_pose) {
        for (int i = 0; i < 3; i++) {
            c.position[i] = ldexp((double)camera->position_q32[i], -32);
        }
        for (int i = 0; i < 4; i++) {
            c.rotation[i] = camera->rotation_q30[i] * 0x1p-30;
        }
    }
    return c;
}

/* Converts a double in [low, high) to fixed point. */
static bool fixed_in(double value, uint32_t fraction_bits, int64_t low, int64_t high, int32_t *out)
{
    int64_t fixed;
    if (t3r_fixed_from_double(t3r_double_bits(value), fraction_bits, &fixed) != 0 || fixed < low || fixed >= high) {
        return false;
    }
    *out = (int32_t)fixed;
    return true;
}

const char *capture_camera_set_intrinsics(const t3r_recorded_camera *camera, t3r_camera *out)
{
    static const int64_t focal = INT64_C(8) << 16, side = INT64_C(16384) << 16;
    out->width = camera->width;
    out->height = camera->height;
    if (!fixed_in(camera->fx, 16, focal, side, &out->fx_q16) || !fixed_in(camera->fy, 16, focal, side, &out->fy_q16)) {
        return "a focal length is outside [8, 16384)";
    }
    if (!fixed_in(camera->cx, 16, -side + 1, side, &out->cx_q16) ||
        !fixed_in(camera->cy, 16, -side + 1, side, &out->cy_q16)) {
        return "the principal point is outside (-16384, 16384)";
    }
    if (!t3r_fixed_centre_is_within(out, out->width, out->height)) {
        return "the principal point is outside the picture";
    }
    bool zero = true;
    int count = camera->distortion == T3R_DISTORTION_NONE ? 0 : camera->distortion == T3R_DISTORTION_FISHEYE ? 4 : 5;
    memset(out->distortion_q24, 0, sizeof out->distortion_q24);
    for (int i = 0; i < count; i++) {
        zero = zero && !(fabs(camera->coefficients[i]) > 0);
        if (!fixed_in(camera->coefficients[i], 24, INT32_MIN, (int64_t)INT32_MAX + 1, &out->distortion_q24[i])) {
            return "a distortion coefficient is outside -128..128";
        }
    }
    out->distortion = zero && camera->distortion != T3R_DISTORTION_FISHEYE ? T3R_DISTORTION_NONE : camera->distortion;
    return NULL;
}

const char *capture_camera_set_pose(const t3r_recorded_camera *camera, t3r_camera *out)
{
    static const int64_t most = INT64_C(3) << 29; /* 1.5 in Q30 */
    for (int i = 0; i < 3; i++) {
        if (t3r_fixed_from_double(t3r_double_bits(camera->position[i]), 32, &out->position_q32[i]) != 0) {
            return "a position is outside -2^31..2^31";
        }
    }
    for (int i = 0; i < 4; i++) {
        if (!fixed_in(camera->rotation[i], 30, -most, most + 1, &out->rotation_q30[i])) {
            return "a rotation is outside -1.5..1.5";
        }
    }
    return NULL;
}
