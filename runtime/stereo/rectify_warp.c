/* Sampling along the rows of a rectified plane. */
#include "core/fixed.h"
#include "rectify.h"

#define ONE_Q24 (INT64_C(1) << 24)

t3r_column t3r_rectified_column(const t3r_rectification *rect, int32_t x_q16)
{
    /* |x| < 2^31, scale at least 2^16 or so: held to 4 */
    int64_t at = t3r_round_div64((int64_t)x_q16 * ONE_Q24, T3R_MAX(rect->scale_q16[0], 1));
    at = t3r_clamp64(at, -4 * ONE_Q24, 4 * ONE_Q24);
    if (!rect->polar) {
        return (t3r_column){(int32_t)at, (int32_t)ONE_Q24};
    }
    return (t3r_column){(int32_t)(2 * at), (int32_t)(ONE_Q24 - t3r_round_shift64(at * at, 24))};
}

/* e(row): its parts along y and z, Q24 */
static void row_direction(const t3r_rectification *rect, uint32_t row, int64_t e_q24[2])
{
    int64_t at = t3r_round_div64(((int64_t)row * 65536 + rect->first_q16[1]) * ONE_Q24, T3R_MAX(rect->scale_q16[1], 1));
    if (!rect->polar) {
        e_q24[0] = at;
        e_q24[1] = ONE_Q24;
        return;
    }
    /* Sector and tangent within it, as rectify.c numbers them: -2..2, |tangent| at most 1 */
    int64_t sector = (at + 5 * ONE_Q24) / (2 * ONE_Q24) - 2; /* at >= -4 - rounding: the sum is positive */
    int64_t tangent = at - 2 * sector * ONE_Q24;
    int64_t length = t3r_isqrt64((uint64_t)(ONE_Q24 * ONE_Q24 + tangent * tangent));
    int64_t one = t3r_round_div64(ONE_Q24 * ONE_Q24, length), slant = t3r_round_div64(tangent * ONE_Q24, length);
    e_q24[0] = sector == 0 ? slant : sector == 1 ? one : sector == -1 ? -one : -slant;
    e_q24[1] = sector == 0 ? one : sector == 1 ? -slant : sector == -1 ? slant : -one;
}

/* f x / z + c in Q16; false when it cannot be in any picture. |x|, |z| < 2^30, z > 0. */
static bool to_pixel(int64_t x, int64_t z, int32_t f_q16, int32_t c_q16, int64_t *pixel_q16)
{
    if (t3r_abs64(x) > 16 * z) {
        return false;
    }
    *pixel_q16 = t3r_round_shift64(t3r_round_div64(x * ONE_Q24, z) * f_q16, 24) + c_q16;
    return true;
}

/* Bilinear, as the undistortion has it: position to Q8, held to the picture, one rounding; 1..255. */
static uint8_t sample(const uint8_t *luma, int32_t width, int32_t height, int64_t u_q16, int64_t v_q16)
{
    int32_t u = (int32_t)t3r_clamp64(t3r_round_shift64(u_q16, 8), 0, (int64_t)(width - 1) << 8);
    int32_t v = (int32_t)t3r_clamp64(t3r_round_shift64(v_q16, 8), 0, (int64_t)(height - 1) << 8);
    int32_t x = u >> 8, y = v >> 8, fx = u & 255, fy = v & 255;
    int32_t right = T3R_MIN(x + 1, width - 1), below = T3R_MIN(y + 1, height - 1);
    const uint8_t *a = luma + (size_t)y * (size_t)width, *b = luma + (size_t)below * (size_t)width;
    int32_t sum = (256 - fy) * ((256 - fx) * a[x] + fx * a[right]) + fy * ((256 - fx) * b[x] + fx * b[right]);
    return (uint8_t)T3R_MAX(t3r_round_shift32(sum, 16), 1);
}

void t3r_rectified_row(const t3r_rectification *rect, uint32_t view, const uint8_t *luma, int32_t x_q16, uint32_t row,
                       uint32_t count, uint8_t *out)
{
    const t3r_rectified_view *v = &rect->view[view];
    const int32_t width = (int32_t)rect->view_width, height = (int32_t)rect->view_height;
    int64_t e[2], direction[3];
    row_direction(rect, row, e);
    for (int i = 0; i < 3; i++) {
        /* |e| below 2^26.1 */
        direction[i] = t3r_round_shift64(e[0] * v->turn_q30[3 * i + 1] + e[1] * v->turn_q30[3 * i + 2], 24);
    }
    for (uint32_t i = 0; i < count; i++) {
        const t3r_column column = t3r_rectified_column(rect, (int32_t)((int64_t)x_q16 + (int64_t)i * 65536));
        int64_t ray[3], u_q16, v_q16;
        out[i] = 0;
        if (column.b_q24 <= 0) {
            continue;
        }
        for (int axis = 0; axis < 3; axis++) {
            /* |a| <= 2^26, |turn| <= 2^30, b <= 2^24, |direction| < 2^32.1: below 2^57.3 */
            ray[axis] =
                t3r_round_shift64((int64_t)column.a_q24 * v->turn_q30[3 * axis] + column.b_q24 * direction[axis], 30);
        }
        if (ray[2] < ONE_Q24 / 64 || !to_pixel(ray[0], ray[2], v->fx_q16, v->cx_q16, &u_q16) ||
            !to_pixel(ray[1], ray[2], v->fy_q16, v->cy_q16, &v_q16)) {
            continue;
        }
        const int64_t x = t3r_round_shift64(u_q16, 16), y = t3r_round_shift64(v_q16, 16);
        if (x >= 0 && y >= 0 && x < width && y < height && luma[y * width + x] != 0) {
            out[i] = sample(luma, width, height, u_q16, v_q16);
        }
    }
}
