/* SPDX-License-Identifier: Apache-2.0 */
/* The geometry of rectification. */
#include "rectify.h"

#include "core/camera.h"
#include "core/fixed.h"
#include "match.h"

#define ONE_Q24 (INT64_C(1) << 24)
#define ONE_Q30 (INT64_C(1) << 30)
/* Baselines shorter than 2^-20 world units have no usable direction in Q32. */
#define LEAST_BASELINE_Q32 (1 << 12)
/* Rotation matrices are the same when their entries differ by at most this: 1/1024. */
#define SAME_ROTATION_Q30 (1 << 20)
/* Planar rectification takes rays up to 2 to the side of 1 ahead. Beyond, planes are stretched more than five times. */
#define PLANAR_MOST 2
/* Polar columns keep this distance from the baseline's own direction, t = 1: 1/32, 3.6 degrees. */
#define POLAR_MOST_Q24 (ONE_Q24 * 31 / 32)
/* Most pixels per unit of column or row: places up to 4 units away fit 32 bits in Q16. */
#define SCALE_MOST_Q16 ((INT64_C(1) << 29) - 1)
/* Points along each side of a picture at which its extent is measured. */
#define BORDER_STEPS 32
/* Rays of a view are clamped to 16 to the side of 1 ahead, as in the pointmap. */
#define RAY_MOST 16
/* Largest slope of a ray of a plane. */
#define PLACE_MOST 4

static int64_t dot(const int64_t a[3], const int64_t b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

/* Computes v / |v| in Q30, |v|_max < 2^30.6. Returns floor(2 |v|); 0: v has no direction. */
static uint64_t unit_q30(const int64_t v[3], int64_t unit[3])
{
    uint64_t twice = t3r_isqrt64(4 * (uint64_t)dot(v, v));
    for (int i = 0; i < 3; i++) {
        unit[i] = twice == 0 ? 0 : t3r_round_div64(v[i] * (INT64_C(1) << 31), (int64_t)twice);
    }
    return twice;
}

/* Subtracts from v, of a length up to 1 (Q30), its part along the unit vector e. */
static void across(const int64_t v[3], const int64_t e[3], int64_t out[3])
{
    int64_t along = t3r_round_shift64(dot(v, e), 30);
    for (int i = 0; i < 3; i++) {
        out[i] = v[i] - t3r_round_shift64(along * e[i], 30);
    }
}

/* Computes the direction and length of the baseline. */
static t3r_pair find_baseline(const t3r_camera *first, const t3r_camera *second, int32_t rotation[2][9],
                              t3r_rectification *rect, int64_t x_q30[3])
{
    int64_t offset[3];
    uint64_t most = 0;
    for (int i = 0; i < 3; i++) {
        offset[i] = second->position_q32[i] - first->position_q32[i]; /* both below 2^62 */
        most = T3R_MAX(most, (uint64_t)t3r_abs64(offset[i]));
    }
    if (most < LEAST_BASELINE_Q32) {
        for (int i = 0; i < 9; i++) {
            if (t3r_abs32(rotation[0][i] / 2 - rotation[1][i] / 2) > SAME_ROTATION_Q30 / 2) {
                return T3R_PAIR_ROTATION;
            }
        }
        return T3R_PAIR_NO_BASELINE;
    }
    int32_t shift = 29 - (int32_t)t3r_msb64(most);
    for (int i = 0; i < 3; i++) {
        offset[i] = t3r_scale64(offset[i], shift); /* at most 2^30 */
    }
    rect->baseline_q31 = (uint32_t)unit_q30(offset, x_q30); /* 2^30..2^31 sqrt 3 */
    rect->baseline_exponent = 30 - shift;
    return T3R_PAIR_OK;
}

/* Computes the axes of the rectified frame: x is given; z is perpendicular to x and as near as possible to the viewing
 * direction of both cameras; y completes them. */
static void complete_axes(int32_t rotation[2][9], int64_t axes[3][3])
{
    int64_t ahead[3], z[3];
    for (int i = 0; i < 3; i++) {
        ahead[i] = t3r_round_shift64((int64_t)rotation[0][3 * i + 2] + rotation[1][3 * i + 2], 1);
    }
    across(ahead, axes[0], z);
    if (unit_q30(z, axes[2]) < ONE_Q30 / 16) {
        /* When looking along the baseline, any direction is possible: the picture's own x axis. It is at least 40
         * degrees from the baseline, as the cameras are less than 90 degrees apart. */
        for (int i = 0; i < 3; i++) {
            ahead[i] = rotation[0][3 * i];
        }
        across(ahead, axes[0], z);
        (void)unit_q30(z, axes[2]);
    }
    for (int i = 0; i < 3; i++) {
        const int j = (i + 1) % 3, k = (i + 2) % 3;
        axes[1][i] = t3r_round_shift64(axes[2][j] * axes[0][k] - axes[2][k] * axes[0][j], 30);
    }
}

/* Computes R^T [x y z]. */
static void turn(const int32_t rotation_q30[9], int64_t axes[3][3], int32_t turn_q30[9])
{
    for (int row = 0; row < 3; row++) {
        const int64_t column[3] = {rotation_q30[row], rotation_q30[3 + row], rotation_q30[6 + row]};
        for (int axis = 0; axis < 3; axis++) {
            turn_q30[3 * row + axis] = (int32_t)t3r_round_shift64(dot(column, axes[axis]), 30);
        }
    }
}

/* Computes the ray of a view's pixel in the rectified frame, Q24; z = 1 in the view. */
static void ray_of(const t3r_rectified_view *view, int32_t u_q16, int32_t v_q16, int64_t ray_q24[3])
{
    const int64_t most = RAY_MOST * ONE_Q24;
    const int64_t x = t3r_round_div64(((int64_t)u_q16 - view->cx_q16) * ONE_Q24, view->fx_q16);
    const int64_t y = t3r_round_div64(((int64_t)v_q16 - view->cy_q16) * ONE_Q24, view->fy_q16);
    const int64_t camera[3] = {t3r_clamp64(x, -most, most), t3r_clamp64(y, -most, most), ONE_Q24};
    for (int i = 0; i < 3; i++) {
        const int64_t axis[3] = {view->turn_q30[i], view->turn_q30[3 + i], view->turn_q30[6 + i]};
        ray_q24[i] = t3r_round_shift64(dot(camera, axis), 30);
    }
}

/* Returns the row of a polar ray, Q24: quarter turns from z by way of y, each 2 long and measured by its tangent. */
static int64_t sector_q24(int64_t y, int64_t z)
{
    if (z >= t3r_abs64(y)) {
        return t3r_round_div64(y * ONE_Q24, z);
    }
    if (y >= t3r_abs64(z)) {
        return 2 * ONE_Q24 + t3r_round_div64(-z * ONE_Q24, y);
    }
    if (-y >= t3r_abs64(z)) {
        return -2 * ONE_Q24 + t3r_round_div64(z * ONE_Q24, -y);
    }
    return (y >= 0 ? 4 : -4) * ONE_Q24 + t3r_round_div64(-y * ONE_Q24, -z);
}

/* Computes column and row of a ray before scaling, Q24. Returns false behind the plane or too close to the baseline's
 * direction. */
static bool project(bool polar, const int64_t ray[3], int64_t at_q24[2], int64_t *across_q24)
{
    if (!polar) {
        /* |ray| <= 2^28.6 */
        if (ray[2] < ONE_Q24 / 64 || t3r_abs64(ray[0]) > PLACE_MOST * ray[2] ||
            t3r_abs64(ray[1]) > PLACE_MOST * ray[2]) {
            return false;
        }
        at_q24[0] = t3r_round_div64(ray[0] * ONE_Q24, ray[2]);
        at_q24[1] = t3r_round_div64(ray[1] * ONE_Q24, ray[2]);
        *across_q24 = ray[2];
        return true;
    }
    int64_t flat = t3r_isqrt64((uint64_t)(ray[1] * ray[1] + ray[2] * ray[2]));
    int64_t length = t3r_isqrt64((uint64_t)dot(ray, ray));
    if (flat == 0) {
        return false;
    }
    at_q24[0] = t3r_round_div64(ray[0] * ONE_Q24, length + flat);
    at_q24[1] = sector_q24(ray[1], ray[2]);
    *across_q24 = flat;
    return t3r_abs64(at_q24[0]) <= POLAR_MOST_Q24;
}

typedef struct extent {
    int64_t least[2], most[2];
} extent;

/* Returns the pixel at step `step` of 4 BORDER_STEPS around the picture. */
static void border(uint32_t width, uint32_t height, uint32_t step, int32_t *u_q16, int32_t *v_q16)
{
    const uint32_t side = step / BORDER_STEPS, along = step % BORDER_STEPS;
    const int32_t right = (int32_t)(width - 1) << 16, bottom = (int32_t)(height - 1) << 16;
    *u_q16 = side == 0   ? (int32_t)((int64_t)right * along / BORDER_STEPS)
             : side == 1 ? right
             : side == 2 ? right - (int32_t)((int64_t)right * along / BORDER_STEPS)
                         : 0;
    *v_q16 = side == 0   ? 0
             : side == 1 ? (int32_t)((int64_t)bottom * along / BORDER_STEPS)
             : side == 2 ? bottom
                         : bottom - (int32_t)((int64_t)bottom * along / BORDER_STEPS);
}

static bool fits_plane(const t3r_rectification *rect, uint32_t view)
{
    for (uint32_t step = 0; step < 4 * BORDER_STEPS; step++) {
        int32_t u, v;
        int64_t ray[3];
        border(rect->view_width, rect->view_height, step, &u, &v);
        ray_of(&rect->view[view], u, v, ray);
        if (ray[2] <= 0 || t3r_abs64(ray[0]) > PLANAR_MOST * ray[2] || t3r_abs64(ray[1]) > PLANAR_MOST * ray[2]) {
            return false;
        }
    }
    return true;
}

/* Returns 1 if the baseline's direction is in the picture, -1 if its opposite is, else 0. */
static int epipole_inside(const t3r_rectification *rect, uint32_t view)
{
    const t3r_rectified_view *v = &rect->view[view];
    const int64_t sign = v->turn_q30[6] < 0 ? -1 : 1;
    const int64_t x = sign * v->turn_q30[0], y = sign * v->turn_q30[3], z = sign * v->turn_q30[6];
    /* u = f x / z + c in [0, width): multiplied by z, Q46 */
    const int64_t u = x * v->fx_q16 + z * v->cx_q16, w = y * v->fy_q16 + z * v->cy_q16;
    const int64_t right = ((int64_t)rect->view_width << 16) * z, bottom = ((int64_t)rect->view_height << 16) * z;
    return u >= 0 && w >= 0 && u < right && w < bottom ? (int)sign : 0;
}

/* Measures the columns and rows that a view covers. */
static extent measure(const t3r_rectification *rect, uint32_t view)
{
    extent e = {{INT64_MAX, INT64_MAX}, {INT64_MIN, INT64_MIN}};
    for (uint32_t step = 0; step < 4 * BORDER_STEPS; step++) {
        int32_t u, v;
        int64_t ray[3], at[2] = {0, 0}, unused;
        border(rect->view_width, rect->view_height, step, &u, &v);
        ray_of(&rect->view[view], u, v, ray);
        if (!project(rect->polar, ray, at, &unused)) { /* polar only: a view that fits a plane always projects */
            at[0] = ray[0] < 0 ? -POLAR_MOST_Q24 : POLAR_MOST_Q24;
        }
        for (int i = 0; i < 2; i++) {
            e.least[i] = T3R_MIN(e.least[i], at[i]);
            e.most[i] = T3R_MAX(e.most[i], at[i]);
        }
    }
    int inside = rect->polar ? epipole_inside(rect, view) : 0;
    if (inside != 0) {
        e.least[1] = -4 * ONE_Q24;
        e.most[1] = 4 * ONE_Q24;
        e.least[0] = inside < 0 ? -POLAR_MOST_Q24 : e.least[0];
        e.most[0] = inside > 0 ? POLAR_MOST_Q24 : e.most[0];
    }
    return e;
}

/* Returns sqrt(f^2 w + g^2 (1 - w)), focal lengths in Q16, w in Q30. Equal lengths are returned unchanged. */
static int64_t blend(int32_t f_q16, int32_t g_q16, int64_t w_q30)
{
    if (f_q16 == g_q16) {
        return f_q16;
    }
    /* Q8, below 2^22; w in Q14: the sum in Q30 below 2^58, in Q32 below 2^60 */
    const int64_t f = f_q16 >> 8, g = g_q16 >> 8, w = w_q30 >> 16;
    return t3r_isqrt64((uint64_t)(f * f * w + g * g * ((1 << 14) - w)) << 2);
}

/* Chooses pixels per unit of column and row, as means over both views. They keep the resolution at the middle of the
 * pictures, with polar planes on the whole. */
static void choose_scale(t3r_rectification *rect)
{
    int64_t sum[2] = {0, 0};
    for (int view = 0; view < 2; view++) {
        const t3r_rectified_view *v = &rect->view[view];
        const int64_t x = v->turn_q30[0], y = v->turn_q30[3];        /* direction of the baseline in the picture */
        const int64_t cos = t3r_clamp64(v->turn_q30[8], 0, ONE_Q30); /* between the optical axis and z */
        const int64_t length = x * x + y * y;
        const int64_t w = length >> 30 == 0 ? ONE_Q30 : T3R_MIN(ONE_Q30, x * x / (length >> 30));
        const int64_t along = blend(v->fx_q16, v->fy_q16, w), beside = blend(v->fy_q16, v->fx_q16, w);
        if (rect->polar) {
            /* dt = (1 + t^2) / 2 of an angle's step; rows are as dense as pixels at some distance from the middle of
             * the picture */
            sum[0] += t3r_round_shift64(along * (ONE_Q30 + cos), 30) * 9 / 8;
            sum[1] += t3r_round_shift64(beside * (ONE_Q30 * 3 / 8 + cos / 2), 30);
        } else {
            sum[0] += t3r_round_shift64(t3r_round_shift64(along * cos, 30) * cos, 30);
            sum[1] += t3r_round_shift64(beside * cos, 30);
        }
    }
    for (int i = 0; i < 2; i++) {
        rect->scale_q16[i] = (int32_t)t3r_clamp64(sum[i] / 2, 1 << 16, SCALE_MOST_Q16);
    }
}

/* Returns the number of pixels from `least` to `most`, both included. */
static uint64_t pixels_between(int64_t least_q24, int64_t most_q24, int32_t scale_q16)
{
    return (uint64_t)t3r_round_shift64((most_q24 - least_q24) * scale_q16, 40) + 1;
}

static int32_t reduced(int32_t scale_q16, uint64_t pixels, uint64_t most)
{
    return pixels <= most ? scale_q16 : (int32_t)((uint64_t)scale_q16 * (most - 1) / pixels);
}

/* Whether matching such a plane takes no more work memory than matching a square one. */
static bool matches_in(uint64_t width, uint64_t height, uint64_t side, uint32_t disparities)
{
    return T3R_MATCH_WORK_BYTES(width, height, disparities, 4) <= T3R_MATCH_WORK_BYTES(side, side, disparities, 4) &&
           T3R_MATCH_WORK_BYTES(width, height, disparities, 8) <= T3R_MATCH_WORK_BYTES(side, side, disparities, 8);
}

/* Sets size and place of the first view's plane: the rows that both views have, and the first view's columns except
 * those left of the second's first, which the second cannot show: points appear further left in it. */
static t3r_pair frame_plane(t3r_rectification *rect, uint32_t disparities)
{
    const uint64_t side = T3R_RECTIFIED_SIDE(rect->view_width, rect->view_height);
    const extent first = measure(rect, 0), second = measure(rect, 1);
    int64_t from[2], to[2];
    for (int i = 0; i < 2; i++) {
        from[i] = T3R_MAX(first.least[i], second.least[i]);
        to[i] = i == 0 ? first.most[0] : T3R_MIN(first.most[1], second.most[1]);
        if (to[i] - from[i] < (first.most[i] - first.least[i]) / 4) {
            return T3R_PAIR_OVERLAP;
        }
    }
    rect->scale_q16[0] = reduced(rect->scale_q16[0], pixels_between(from[0], to[0], rect->scale_q16[0]), side);
    uint64_t width = pixels_between(from[0], to[0], rect->scale_q16[0]);
    /* the wider right plane has no more pixels than with a square left plane */
    uint64_t tallest = rect->polar ? side * (side + disparities) / (width + disparities) : side;
    tallest = T3R_MIN(tallest, T3R_MAX_SIDE);
    while (tallest > side && !matches_in(width, tallest, side, disparities)) {
        tallest -= 8; /* at most T3R_MAX_SIDE / 8 times */
    }
    rect->scale_q16[1] = reduced(rect->scale_q16[1], pixels_between(from[1], to[1], rect->scale_q16[1]), tallest);
    uint64_t height = pixels_between(from[1], to[1], rect->scale_q16[1]);
    if (width < T3R_RECTIFIED_LEAST || height < T3R_RECTIFIED_LEAST) {
        return T3R_PAIR_OVERLAP;
    }
    rect->width = (uint32_t)width;
    rect->height = (uint32_t)height;
    for (int i = 0; i < 2; i++) {
        rect->first_q16[i] = (int32_t)t3r_round_shift64(from[i] * rect->scale_q16[i], 24);
    }
    int64_t least = ((from[0] - second.most[0]) * rect->scale_q16[0]) >> 40;
    int64_t most = ((to[0] - second.least[0]) * rect->scale_q16[0]) >> 40; /* at least 0, because they overlap */
    rect->least_disparity = (int32_t)T3R_MAX(least, 0);
    rect->most_disparity = (int32_t)most + 1;
    return T3R_PAIR_OK;
}

t3r_pair t3r_rectify(const t3r_camera *first, const t3r_camera *second, uint32_t width, uint32_t height,
                     uint32_t disparities, t3r_rectification *rect)
{
    const t3r_camera *cameras[2] = {first, second};
    int32_t rotation[2][9];
    int64_t axes[3][3], facing = 0;
    for (int i = 0; i < 2; i++) {
        t3r_camera_rotation(cameras[i]->rotation_q30, rotation[i]);
    }
    rect->view_width = width;
    rect->view_height = height;
    t3r_pair pair = find_baseline(first, second, rotation, rect, axes[0]);
    if (pair != T3R_PAIR_OK) {
        return pair;
    }
    for (int i = 0; i < 3; i++) {
        facing += (int64_t)rotation[0][3 * i + 2] * rotation[1][3 * i + 2];
    }
    if (facing <= 0) {
        return T3R_PAIR_OVERLAP; /* at least 90 degrees apart */
    }
    complete_axes(rotation, axes);
    for (int i = 0; i < 2; i++) {
        t3r_rectified_view *view = &rect->view[i];
        *view =
            (t3r_rectified_view){cameras[i]->fx_q16, cameras[i]->fy_q16, cameras[i]->cx_q16, cameras[i]->cy_q16, {0}};
        turn(rotation[i], axes, view->turn_q30);
    }
    rect->polar = !fits_plane(rect, 0) || !fits_plane(rect, 1);
    choose_scale(rect);
    pair = frame_plane(rect, disparities);
    rect->column_scale = t3r_divisor_of((uint32_t)T3R_MAX(rect->scale_q16[0], 1));
    return pair;
}

bool t3r_rectified_place(const t3r_rectification *rect, uint32_t view, int32_t u_q16, int32_t v_q16,
                         int32_t place_q16[2], int32_t *across_q24)
{
    int64_t ray[3], at[2], flat;
    ray_of(&rect->view[view], u_q16, v_q16, ray);
    if (!project(rect->polar, ray, at, &flat)) {
        return false;
    }
    for (int i = 0; i < 2; i++) {
        /* |at| at most 4, scales below 2^31 */
        int64_t place = t3r_round_shift64(at[i] * rect->scale_q16[i], 24) - (i == 1 ? rect->first_q16[1] : 0);
        place_q16[i] = (int32_t)t3r_clamp64(place, INT32_MIN, INT32_MAX);
    }
    *across_q24 = (int32_t)flat; /* at most 2^28.6 */
    return true;
}

void t3r_view_columns_of(const t3r_rectification *rect, uint32_t view, uint32_t u, uint32_t step, uint32_t count,
                         t3r_view_columns *columns)
{
    const t3r_rectified_view *from = &rect->view[view];
    const t3r_divisor fx = t3r_divisor_of((uint32_t)from->fx_q16);
    columns->u = u;
    columns->step = step;
    columns->count = count;
    for (uint32_t i = 0; i < T3R_RAYS; i++) {
        const int64_t x_q16 = ((int64_t)(u + i * step) << 16) - from->cx_q16;
        columns->x_q24[i] = i < count ? t3r_divide_q24(&fx, x_q16, RAY_MOST) : 0;
    }
}

/* Computes places in planes, for rays up to 4 to the side: kernels/ray_row.h needs their z below 2^27. */
static bool places_in_plane(const t3r_kernels *kernels, const t3r_rectification *rect, uint32_t view,
                            const t3r_view_columns *columns, uint32_t v, t3r_ray_places *places)
{
    static const int32_t none[T3R_RAYS];
    const t3r_rectified_view *from = &rect->view[view];
    const int64_t y_q16 = ((int64_t)v << 16) - from->cy_q16, most = 4 * ONE_Q24;
    const int64_t y =
        t3r_clamp64(t3r_round_div64(y_q16 * ONE_Q24, from->fy_q16), -RAY_MOST * ONE_Q24, RAY_MOST * ONE_Q24);
    t3r_ray_map map = {.steepest = PLACE_MOST,
                       .scale_q16 = {rect->scale_q16[0], rect->scale_q16[1]},
                       .offset_q16 = {0, -rect->first_q16[1]}};
    /* columns rise, so the first and last are the outermost */
    if (t3r_abs64(y) > most || columns->x_q24[0] < -most || columns->x_q24[columns->count - 1] > most) {
        return false;
    }
    for (int i = 0; i < 3; i++) {
        map.turn_q30[i] = from->turn_q30[i];
        map.base_q54[i] = y * from->turn_q30[3 + i] + ONE_Q24 * from->turn_q30[6 + i];
    }
    kernels->ray_row(&map, columns->x_q24, none, (columns->count + 15) & ~15u, places);
    return true;
}

void t3r_rectified_places(const t3r_kernels *kernels, const t3r_rectification *rect, uint32_t view,
                          const t3r_view_columns *columns, uint32_t v, t3r_ray_places *places)
{
    if (!rect->polar && places_in_plane(kernels, rect, view, columns, v, places)) {
        return;
    }
    for (uint32_t i = 0; i < columns->count; i++) {
        int32_t place[2] = {0, 0}, across_q24 = 0;
        (void)t3r_rectified_place(rect, view, (int32_t)((columns->u + i * columns->step) << 16), (int32_t)(v << 16),
                                  place, &across_q24);
        places->x_q16[i] = place[0];
        places->y_q16[i] = place[1];
        places->z_q24[i] = across_q24;
    }
}
