/* Lens distortion as a grid of source positions, and sampling through the grid. */
#include "undistort.h"

#include <stdbool.h>

#include "core/fixed.h"

#define ONE_Q24 (INT64_C(1) << 24)
#define STEP_SHIFT 3 /* log2 of T3R_GRID_STEP */
_Static_assert(T3R_GRID_STEP == 1 << STEP_SHIFT, "grid step");

/* Normalised image coordinates stay below 64: 89.1 degrees off the axis. */
#define NORMALISED_MOST_Q24 (64 * ONE_Q24)
/* Bound of source positions in pixels, so that Q16 fits 32 bits. */
#define POSITION_MOST_Q16 (INT64_C(32767) << 16)

/* Steps of 1/256 in radius (radial-tangential: below 8) or angle (fisheye: below pi / 2) in the search for the fold of
 * the polynomial. */
#define RADIUS_STEPS 2047
#define ANGLE_STEPS 402

#define CORDIC_STEPS 32
/* atan(2^-i), nearest */
static const int64_t atan_q40[CORDIC_STEPS] = {
    863554413089, 509785937287, 269356888665, 136729762476, 68630207382, 34348560106, 17178471287, 8589759836,
    4294945451,   2147480917,   1073741483,   536870869,    268435451,   134217727,   67108864,    33554432,
    16777216,     8388608,      4194304,      2097152,      1048576,     524288,      262144,      131072,
    65536,        32768,        16384,        8192,         4096,        2048,        1024,        512,
};

/* The radial part of a lens: factor(s) = 1 + k[0] s + k[1] s^2 + ..., s the squared radius or angle. */
typedef struct lens {
    int64_t k_q24[4];
    uint32_t terms;
    int64_t limit_q24; /* largest s below the fold, within the search */
} lens;

/* Stores a b in Q24, round-half-up. Returns false, with *product unchanged, when it might not fit. */
static bool multiply_q24(int64_t a, int64_t b, int64_t *product)
{
    /* |a| < 2^(msb + 1) and likewise b, so the product stays below 2^62 */
    if (t3r_msb64((uint64_t)t3r_abs64(a) | 1) + t3r_msb64((uint64_t)t3r_abs64(b) | 1) + 2 > 62) {
        return false;
    }
    *product = t3r_round_shift64(a * b, 24);
    return true;
}

/* Computes factor(s), or with `slope` the derivative of t factor(t^2) at t^2 = s: 1 + 3 k[0] s + 5 k[1] s^2 + ... A sum
 * stays below 2^38 + 9 x 2^31. */
static bool radial(const lens *model, int64_t s_q24, bool slope, int64_t *value_q24)
{
    int64_t value = 0;

    for (uint32_t i = model->terms; i-- > 0;) {
        value += model->k_q24[i] * (slope ? 2 * (int64_t)i + 3 : 1);
        if (!multiply_q24(value, s_q24, &value)) {
            return false;
        }
    }
    *value_q24 = value + ONE_Q24;
    return true;
}

static lens lens_of(const t3r_camera *camera)
{
    bool fisheye = camera->distortion == T3R_DISTORTION_FISHEYE;
    const int32_t *k = camera->distortion_q24;
    lens model = {{k[0], k[1], fisheye ? k[2] : k[4], k[3]}, fisheye ? 4 : 3, 0};
    uint32_t steps = fisheye ? ANGLE_STEPS : RADIUS_STEPS;

    for (uint32_t i = 1; i <= steps; i++) {
        int64_t s = (int64_t)i * i << 8;
        int64_t slope;
        if (!radial(&model, s, true, &slope) || slope <= 0) {
            break;
        }
        model.limit_q24 = s;
    }
    return model;
}

/* Returns atan(r) in Q24 for 0 <= r < 2^7, error below 2^-24: turns the vector (1, r) onto the x axis. Its length grows
 * to 1.65 x 2^47. */
static int64_t atan_q24(int64_t r_q24)
{
    int64_t x = ONE_Q24 << 16;
    int64_t y = r_q24 * 65536;
    int64_t angle = 0;

    for (uint32_t i = 0; i < CORDIC_STEPS; i++) {
        int64_t dx = t3r_round_shift64(y, i);
        int64_t dy = t3r_round_shift64(x, i);
        bool above = y >= 0;
        x += above ? dx : -dx;
        y += above ? -dy : dy;
        angle += above ? atan_q40[i] : -atan_q40[i];
    }
    return t3r_round_shift64(angle, 16);
}

/* Applies the lens to the ray (x, y, 1). Returns false when the ray is beyond the fold. |x|, |y| < 2^30. */
static bool distort_radtan(const lens *model, const int32_t *k_q24, int64_t x, int64_t y, int64_t *out_x,
                           int64_t *out_y)
{
    int64_t xx = t3r_round_shift64(x * x, 24);
    int64_t yy = t3r_round_shift64(y * y, 24);
    int64_t r2 = xx + yy;
    int64_t factor, radial_x, radial_y;

    if (r2 > model->limit_q24 || !radial(model, r2, false, &factor) || !multiply_q24(x, factor, &radial_x) ||
        !multiply_q24(y, factor, &radial_y)) {
        return false;
    }
    /* r2 < 64, so 2 xy and r2 + 2 xx are below 192 = 2^31.6 in Q24; |p| < 2^28: no overflow */
    int64_t xy2 = t3r_round_shift64(2 * x * y, 24);
    int64_t p1 = k_q24[2], p2 = k_q24[3];
    *out_x = radial_x + t3r_round_shift64(p1 * xy2 + p2 * (r2 + 2 * xx), 24);
    *out_y = radial_y + t3r_round_shift64(p1 * (r2 + 2 * yy) + p2 * xy2, 24);
    return true;
}

static bool distort_fisheye(const lens *model, int64_t x, int64_t y, int64_t *out_x, int64_t *out_y)
{
    int64_t r = t3r_isqrt64((uint64_t)(x * x + y * y)); /* Q48 to Q24 */
    int64_t angle = atan_q24(r);
    int64_t angle2, factor, bent;

    *out_x = x;
    *out_y = y;
    if (r == 0) {
        return true;
    }
    if (!multiply_q24(angle, angle, &angle2) || angle2 > model->limit_q24 || !radial(model, angle2, false, &factor) ||
        !multiply_q24(angle, factor, &bent) || t3r_abs64(bent) >= INT64_C(1) << 31) {
        return false;
    }
    *out_x = t3r_round_div64(x * bent, r);
    *out_y = t3r_round_div64(y * bent, r);
    return true;
}

/* Computes f x + c in Q16. Returns false when it is out of range. */
static bool to_pixel(int32_t f_q16, int32_t c_q16, int64_t x_q24, int32_t *pixel_q16)
{
    if (t3r_abs64(x_q24) >= INT64_C(1) << 31) {
        return false;
    }
    int64_t position = t3r_round_shift64(f_q16 * x_q24, 24) + c_q16;
    if (t3r_abs64(position) > POSITION_MOST_Q16) {
        return false;
    }
    *pixel_q16 = (int32_t)position;
    return true;
}

/* Computes the source position of pinhole pixel (u, v). */
static bool source_of(const t3r_camera *camera, const lens *model, uint32_t u, uint32_t v, int32_t node[2])
{
    if (camera->distortion == T3R_DISTORTION_NONE) {
        node[0] = (int32_t)(u << 16);
        node[1] = (int32_t)(v << 16);
        return true;
    }
    /* numerators below 2^55 */
    int64_t x = t3r_round_div64((((int64_t)u << 16) - camera->cx_q16) * ONE_Q24, camera->fx_q16);
    int64_t y = t3r_round_div64((((int64_t)v << 16) - camera->cy_q16) * ONE_Q24, camera->fy_q16);
    if (t3r_abs64(x) >= NORMALISED_MOST_Q24 || t3r_abs64(y) >= NORMALISED_MOST_Q24) {
        return false;
    }
    int64_t bent_x, bent_y;
    bool reached = camera->distortion == T3R_DISTORTION_FISHEYE
                       ? distort_fisheye(model, x, y, &bent_x, &bent_y)
                       : distort_radtan(model, camera->distortion_q24, x, y, &bent_x, &bent_y);
    return reached && to_pixel(camera->fx_q16, camera->cx_q16, bent_x, &node[0]) &&
           to_pixel(camera->fy_q16, camera->cy_q16, bent_y, &node[1]);
}

static uint32_t nodes_across(uint32_t side)
{
    return side / T3R_GRID_STEP + 2;
}

t3r_status t3r_undistort_grid(const t3r_camera *camera, uint32_t width, uint32_t height, int32_t *grid)
{
    lens model = lens_of(camera);
    uint32_t across = nodes_across(width), down = nodes_across(height);
    uint32_t outside = 0;

    for (uint32_t j = 0; j < down; j++) {
        for (uint32_t i = 0; i < across; i++) {
            int32_t *node = grid + 2 * ((size_t)j * across + i);
            if (!source_of(camera, &model, i * T3R_GRID_STEP, j * T3R_GRID_STEP, node)) {
                node[0] = T3R_GRID_OUTSIDE;
                node[1] = T3R_GRID_OUTSIDE;
                outside++;
            }
        }
    }
    return 2 * outside > across * down ? T3R_ERR_CAMERA : T3R_OK;
}

/* Computes the source positions of the pixels of row y in one cell of the grid, Q16. Returns false when the cell is
 * outside. */
static bool cell_positions(const int32_t *grid, uint32_t width, uint32_t cell, uint32_t y,
                           int32_t positions[T3R_GRID_STEP][2])
{
    uint32_t across = nodes_across(width);
    const int32_t *upper = grid + 2 * ((size_t)(y / T3R_GRID_STEP) * across + cell);
    const int32_t *lower = upper + 2 * (size_t)across;
    int64_t below = y % T3R_GRID_STEP;

    if (upper[0] == T3R_GRID_OUTSIDE || upper[2] == T3R_GRID_OUTSIDE || lower[0] == T3R_GRID_OUTSIDE ||
        lower[2] == T3R_GRID_OUTSIDE) {
        return false;
    }
    for (uint32_t c = 0; c < 2; c++) {
        /* weights of 8, then of 64: below 2^37 */
        int64_t left = upper[c] * (T3R_GRID_STEP - below) + lower[c] * below;
        int64_t right = upper[2 + c] * (T3R_GRID_STEP - below) + lower[2 + c] * below;
        for (int64_t i = 0; i < T3R_GRID_STEP; i++) {
            positions[i][c] = (int32_t)t3r_round_shift64(left * T3R_GRID_STEP + (right - left) * i, 2 * STEP_SHIFT);
        }
    }
    return true;
}

/* Whether the nearest pixel lies in the image. */
static bool inside(const int32_t position[2], uint32_t width, uint32_t height)
{
    int64_t x = t3r_round_shift64(position[0], 16);
    int64_t y = t3r_round_shift64(position[1], 16);
    return x >= 0 && y >= 0 && x < width && y < height;
}

/* A pixel and its next neighbour along one axis, clamped to the image, and the neighbour's weight in 256ths. */
typedef struct tap {
    uint32_t first, second;
    uint32_t weight;
} tap;

static tap tap_at(int32_t position_q16, uint32_t side)
{
    int64_t position_q8 = t3r_round_shift64(position_q16, 8);
    uint32_t held = (uint32_t)t3r_clamp64(position_q8, 0, (int64_t)(side - 1) << 8);
    tap t = {held >> 8, T3R_MIN((held >> 8) + 1, side - 1), held & 255};
    return t;
}

static uint8_t bilinear(const uint8_t *plane, uint32_t width, tap x, tap y)
{
    const uint8_t *upper = plane + (size_t)y.first * width;
    const uint8_t *lower = plane + (size_t)y.second * width;
    uint32_t above = upper[x.first] * (256 - x.weight) + upper[x.second] * x.weight;
    uint32_t below = lower[x.first] * (256 - x.weight) + lower[x.second] * x.weight;
    /* at most 255 x 2^16 */
    return (uint8_t)t3r_round_shift32((int32_t)(above * (256 - y.weight) + below * y.weight), 16);
}

void t3r_undistort_colour(const int32_t *grid, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                          const uint8_t *const source[3], uint8_t *const out[3])
{
    int32_t positions[T3R_GRID_STEP][2];

    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < width; x += T3R_GRID_STEP) {
            bool shown = cell_positions(grid, width, x / T3R_GRID_STEP, y, positions);
            uint32_t count = T3R_MIN(T3R_GRID_STEP, width - x);
            for (uint32_t i = 0; i < count; i++) {
                size_t at = (size_t)y * width + x + i;
                if (!shown || !inside(positions[i], width, height)) {
                    out[0][at] = out[1][at] = out[2][at] = 0;
                    continue;
                }
                tap across = tap_at(positions[i][0], width);
                tap down = tap_at(positions[i][1], height);
                for (uint32_t c = 0; c < 3; c++) {
                    out[c][at] = bilinear(source[c], width, across, down);
                }
            }
        }
    }
}

void t3r_undistort_depth(const int32_t *grid, uint32_t width, uint32_t height, uint32_t begin, uint32_t end,
                         const uint16_t *source, uint16_t *out)
{
    int32_t positions[T3R_GRID_STEP][2];

    for (uint32_t y = begin; y < end; y++) {
        for (uint32_t x = 0; x < width; x += T3R_GRID_STEP) {
            bool shown = cell_positions(grid, width, x / T3R_GRID_STEP, y, positions);
            uint32_t count = T3R_MIN(T3R_GRID_STEP, width - x);
            for (uint32_t i = 0; i < count; i++) {
                size_t at = (size_t)y * width + x + i;
                out[at] = 0;
                if (shown && inside(positions[i], width, height)) {
                    int64_t from_x = t3r_round_shift64(positions[i][0], 16);
                    int64_t from_y = t3r_round_shift64(positions[i][1], 16);
                    out[at] = source[(size_t)from_y * width + (size_t)from_x];
                }
            }
        }
    }
}
