/* SPDX-License-Identifier: Apache-2.0 */
#include "fixed_camera.h"

#include "fixed_double.h"
#include "mcap/reader_limits.h"

static bool fixed_in(uint64_t f64, uint32_t fraction_bits, int64_t low, int64_t high, int32_t *out)
{
    int64_t fixed;
    if (t3r_fixed_from_double(f64, fraction_bits, &fixed) != 0 || fixed < low || fixed >= high) {
        return false;
    }
    *out = (int32_t)fixed;
    return true;
}

bool t3r_fixed_focal(uint64_t f64, int32_t *q16)
{
    return fixed_in(f64, 16, (int64_t)T3R_LIMIT_FOCAL_LEAST << 16, (int64_t)T3R_LIMIT_PIXELS << 16, q16);
}

bool t3r_fixed_centre(uint64_t f64, int32_t *q16)
{
    return fixed_in(f64, 16, -((int64_t)T3R_LIMIT_PIXELS << 16) + 1, (int64_t)T3R_LIMIT_PIXELS << 16, q16);
}

bool t3r_fixed_position(uint64_t f64, int64_t *q32)
{
    const int64_t most = INT64_C(1) << (T3R_LIMIT_POSITION_LOG2 + 32);
    return t3r_fixed_from_double(f64, 32, q32) == 0 && *q32<most && * q32> - most;
}

bool t3r_fixed_rotation(uint64_t f64, int32_t *q30)
{
    const int64_t most = INT64_C(3) << 29; /* 1.5 */
    return fixed_in(f64, 30, -most, most + 1, q30);
}

bool t3r_fixed_coefficient(uint64_t f64, t3r_distortion distortion, uint32_t index, int32_t *q24)
{
    bool tangential = distortion == T3R_DISTORTION_RADTAN && (index == 2 || index == 3);
    int64_t most = (int64_t)(tangential ? T3R_LIMIT_TANGENTIAL : T3R_LIMIT_DISTORTION) << 24;
    return fixed_in(f64, 24, tangential ? -most + 1 : -most, most, q24);
}

bool t3r_fixed_depth_unit(double unit, uint64_t *q40)
{
    int64_t fixed;
    if (t3r_fixed_from_double(t3r_double_bits(unit), 40, &fixed) != 0 || fixed <= 0 ||
        fixed >= (int64_t)T3R_LIMIT_DEPTH_UNIT << 40) {
        return false;
    }
    *q40 = (uint64_t)fixed;
    return true;
}

const char *t3r_fixed_camera(const t3r_recorded_camera *in, t3r_camera *out)
{
    *out = (t3r_camera){.width = in->width, .height = in->height, .distortion = in->distortion};
    if (!t3r_fixed_focal(t3r_double_bits(in->fx), &out->fx_q16) ||
        !t3r_fixed_focal(t3r_double_bits(in->fy), &out->fy_q16)) {
        return T3R_LIMIT_TEXT("fl_x, fl_y: ", T3R_LIMIT_FOCAL_LEAST,
                              T3R_LIMIT_TEXT(" to ", T3R_LIMIT_PIXELS, " pixels are supported"));
    }
    if (!t3r_fixed_centre(t3r_double_bits(in->cx), &out->cx_q16) ||
        !t3r_fixed_centre(t3r_double_bits(in->cy), &out->cy_q16)) {
        return T3R_LIMIT_TEXT("cx, cy: less than ", T3R_LIMIT_PIXELS, " pixels are supported");
    }
    for (uint32_t i = 0; i < 5; i++) {
        if (!t3r_fixed_coefficient(t3r_double_bits(in->coefficients[i]), in->distortion, i, &out->distortion_q24[i])) {
            return T3R_LIMIT_TEXT("distortion: coefficients of less than ", T3R_LIMIT_DISTORTION,
                                  T3R_LIMIT_TEXT(", p1 and p2 of less than ", T3R_LIMIT_TANGENTIAL, " are supported"));
        }
    }
    for (uint32_t i = 0; i < 3; i++) {
        if (!t3r_fixed_position(t3r_double_bits(in->position[i]), &out->position_q32[i])) {
            return T3R_LIMIT_TEXT("position: less than 2^", T3R_LIMIT_POSITION_LOG2, " is supported");
        }
    }
    for (uint32_t i = 0; i < 4; i++) {
        if (!t3r_fixed_rotation(t3r_double_bits(in->rotation[i]), &out->rotation_q30[i])) {
            return "rotation: unit quaternions are supported";
        }
    }
    return NULL;
}

bool t3r_fixed_centre_is_within(const t3r_camera *camera, uint32_t width, uint32_t height)
{
    const int64_t x_q16 = (int64_t)camera->cx_q16 + 0x8000, y_q16 = (int64_t)camera->cy_q16 + 0x8000;
    return x_q16 >= 0 && y_q16 >= 0 && x_q16 <= (int64_t)width << 16 && y_q16 <= (int64_t)height << 16;
}
