/* SPDX-License-Identifier: Apache-2.0 */
#include "plane_sweep.h"

#include "core/camera.h"
#include "core/fixed.h"
#include "depth/surroundings.h"

/* SAMPLES x SAMPLES pixels of a cell are compared, of a smaller cell all. */
#define SAMPLES 4u
/* A label counts as seen with SEEN of 5 samples in the other picture. */
#define SEEN 2
/* A comparison that differs costs 1/4, at most 4 of them count, and matched pixels take away up to 0.7 of that. */
#define DIFFERS_MOST 64
#define MATCHED_Q8 179
/* A ray is at most RAY_MOST to the side of 1 ahead, and its point at least LEAST_Z of the distance ahead. */
#define RAY_MOST 16
#define ONE_Q24 (INT64_C(1) << 24)
#define LEAST_Z (ONE_Q24 / 64)
/* Bounds of the offset: 2^22 steps of depth, Q12, as in the unit; and 256 times a point's distance, Q24 */
#define STEPS_MOST (INT64_C(1) << 34)
#define OFFSET_MOST (INT64_C(1) << 32)
#define UNSEEN INT32_MAX

/* The way from pixels of a view to those of another one. */
typedef struct sweep {
    const t3r_plane_labels *labels;
    const t3r_camera *camera, *other;
    int64_t turn_q30[9];   /* from the view's frame to the other's */
    int64_t offset_q12[3]; /* of the view's centre in the other's frame, steps of depth */
    const uint8_t *census, *census_other, *luma_other;
} sweep;

static int64_t dot(const int32_t *a, const int64_t b[3])
{
    return t3r_round_shift64(a[0] * b[0], 30) + t3r_round_shift64(a[3] * b[1], 30) + t3r_round_shift64(a[6] * b[2], 30);
}

/* Computes the turn and the offset. */
static void relate(sweep *s)
{
    int32_t own[9], other[9];
    t3r_camera_rotation(s->camera->rotation_q30, own);
    t3r_camera_rotation(s->other->rotation_q30, other);
    int64_t apart[3];
    uint64_t most = s->labels->view->depth_unit_q40;
    for (int i = 0; i < 3; i++) {
        apart[i] = s->camera->position_q32[i] - s->other->position_q32[i]; /* below 2^63 */
        most = T3R_MAX(most, (uint64_t)t3r_abs64(apart[i]));
    }
    /* to at most 31 bits */
    const int32_t shift = -T3R_MAX((int32_t)t3r_msb64(most) - 30, 0);
    const int64_t unit = T3R_MAX(t3r_scale64((int64_t)s->labels->view->depth_unit_q40, shift), 1);
    for (int i = 0; i < 3; i++) {
        apart[i] = t3r_scale64(apart[i], shift);
    }
    for (int r = 0; r < 3; r++) {
        for (int c = 0; c < 3; c++) {
            const int64_t column[3] = {own[c], own[3 + c], own[6 + c]};
            s->turn_q30[3 * r + c] = dot(&other[r], column);
        }
        /* positions have 8 fraction bits fewer than the unit */
        s->offset_q12[r] =
            t3r_clamp64(t3r_round_div64(dot(&other[r], apart) * (1 << 20), unit), -STEPS_MOST, STEPS_MOST);
    }
}

/* Returns a coordinate of a picture, Q16, of x / z. */
static int64_t place_q16(int64_t x_q24, int64_t z_q24, int32_t f_q16, int32_t c_q16)
{
    return t3r_round_shift64(f_q16 * t3r_round_div64(x_q24 * ONE_Q24, z_q24), 24) + c_q16;
}

/* Computes the ray of a pixel, turned to the other view's frame, Q24. */
static void turned_ray(const sweep *s, uint32_t u, uint32_t v, int64_t turned_q24[3])
{
    const int64_t most = RAY_MOST * ONE_Q24;
    const int64_t x = t3r_round_div64(((int64_t)u * 65536 - s->camera->cx_q16) * ONE_Q24, s->camera->fx_q16);
    const int64_t y = t3r_round_div64(((int64_t)v * 65536 - s->camera->cy_q16) * ONE_Q24, s->camera->fy_q16);
    const int64_t ray_q24[3] = {t3r_clamp64(x, -most, most), t3r_clamp64(y, -most, most), ONE_Q24};
    for (int i = 0; i < 3; i++) {
        const int64_t *row = &s->turn_q30[3 * i];
        turned_q24[i] = t3r_round_shift64(row[0] * ray_q24[0] + row[1] * ray_q24[1] + row[2] * ray_q24[2], 30);
    }
}

typedef struct pixel {
    uint32_t u, v;
} pixel;

/* Finds the pixel of the other view that shows a point of a turned ray. Returns false if there is none. */
static bool find_shown(const sweep *s, const int64_t turned_q24[3], int64_t inverse_q8, pixel *at)
{
    const t3r_view *view = s->labels->view;
    const int64_t inverse_q28 = t3r_round_shift64(inverse_q8, 10); /* below 2^26 */
    int64_t point[3];
    for (int i = 0; i < 3; i++) {
        const int64_t moved = t3r_round_shift64(s->offset_q12[i] * inverse_q28, 16); /* offset: below 2^34 */
        point[i] = turned_q24[i] + t3r_clamp64(moved, -OFFSET_MOST, OFFSET_MOST);
    }
    if (point[2] < LEAST_Z || t3r_abs64(point[0]) > RAY_MOST * point[2] || t3r_abs64(point[1]) > RAY_MOST * point[2]) {
        return false;
    }
    const int64_t u = t3r_round_shift64(place_q16(point[0], point[2], s->other->fx_q16, s->other->cx_q16), 16);
    const int64_t v = t3r_round_shift64(place_q16(point[1], point[2], s->other->fy_q16, s->other->cy_q16), 16);
    *at = (pixel){(uint32_t)u, (uint32_t)v};
    return u >= 0 && v >= 0 && u < view->width && v < view->height;
}

static uint32_t bits_of(const uint8_t *census, uint32_t width, pixel at)
{
    const uint8_t *first = census + (size_t)at.v * width * T3R_CENSUS_BYTES + at.u;
    return first[0] | (uint32_t)first[width] << 8 | (uint32_t)first[2 * (size_t)width] << 16;
}

/* Returns the number of ones of 24 bits. */
static int32_t ones(uint32_t bits)
{
    bits -= bits >> 1 & 0x555555u;
    bits = (bits & 0x333333u) + (bits >> 2 & 0x333333u);
    bits = (bits + (bits >> 4)) & 0x0f0f0fu;
    return (int32_t)(bits * 0x010101u >> 16 & 0xffu);
}

/* Computes the mean number of comparisons that differ in a cell, Q4, of each label, and returns the least. */
static int32_t compare(const sweep *s, uint32_t cell, int32_t *differ_q4)
{
    const t3r_plane_labels *labels = s->labels;
    const uint32_t width = labels->view->width, height = labels->view->height;
    const uint32_t left = cell % labels->columns * labels->cell, top = cell / labels->columns * labels->cell;
    const uint32_t samples = T3R_MIN(SAMPLES, labels->cell);
    int32_t seen[T3R_LABELS_MOST] = {0}, differ[T3R_LABELS_MOST] = {0}, least = UNSEEN;
    for (uint32_t k = 0; k < samples * samples; k++) {
        const uint32_t u = left + (2 * (k % samples) + 1) * labels->cell / (2 * samples);
        const uint32_t v = top + (2 * (k / samples) + 1) * labels->cell / (2 * samples);
        if (u >= width || v >= height) {
            continue;
        }
        int64_t turned[3];
        turned_ray(s, u, v, turned);
        const uint32_t own = bits_of(s->census, width, (pixel){u, v});
        for (uint32_t l = 0; l < labels->count; l++) {
            const int64_t inverse_q8 = T3R_MIN(t3r_label_at_q8(labels, l, u, v), labels->most_q8);
            pixel at;
            if (inverse_q8 > 0 && find_shown(s, turned, inverse_q8, &at) &&
                s->luma_other[(size_t)at.v * width + at.u] != 0) {
                seen[l]++;
                differ[l] += ones(own ^ bits_of(s->census_other, width, at));
            }
        }
    }
    for (uint32_t l = 0; l < labels->count; l++) {
        const bool judged = 5 * seen[l] >= SEEN * (int32_t)(samples * samples);
        differ_q4[l] = judged ? t3r_round_div32(16 * differ[l], seen[l]) : UNSEEN;
        least = T3R_MIN(least, differ_q4[l]);
    }
    return least;
}

/* Computes the census of a view, a row after the other; luma: of the view, set here. */
static void census_of(const t3r_kernels *kernels, const t3r_view *view, uint8_t *luma, uint8_t *census)
{
    t3r_luma_of_view(view, luma);
    for (uint32_t y = 0; y < view->height; y++) {
        const uint8_t *rows[T3R_CENSUS_ROWS];
        for (int32_t i = 0; i < T3R_CENSUS_ROWS; i++) {
            const int32_t row = t3r_clamp32((int32_t)y + i - T3R_CENSUS_ROWS / 2, 0, (int32_t)view->height - 1);
            rows[i] = luma + (size_t)row * view->width;
        }
        kernels->census_row(rows, view->width, view->width, census + (size_t)y * view->width * T3R_CENSUS_BYTES);
    }
}

void t3r_plane_sweep(const t3r_plane_labels *labels, const t3r_kernels *kernels, const t3r_camera *camera,
                     const t3r_view *other, const t3r_camera *other_camera, t3r_cut *cut)
{
    const size_t pixels = T3R_PIXELS_(other->width, other->height);
    uint8_t *luma = t3r_take(cut, pixels);
    uint8_t *census[2] = {t3r_take(cut, pixels * T3R_CENSUS_BYTES), t3r_take(cut, pixels * T3R_CENSUS_BYTES)};
    census_of(kernels, labels->view, luma, census[0]);
    census_of(kernels, other, luma, census[1]);
    sweep s = {.labels = labels,
               .camera = camera,
               .other = other_camera,
               .census = census[0],
               .census_other = census[1],
               .luma_other = luma};
    relate(&s);
    for (uint32_t cell = 0; cell < labels->columns * labels->rows; cell++) {
        int32_t differ[T3R_LABELS_MOST] = {0};
        const int32_t least = compare(&s, cell, differ);
        const int32_t weight_q16 = 65536 - MATCHED_Q8 * labels->share_q8[cell];
        for (uint32_t l = 0; l < labels->count; l++) {
            const int32_t more = differ[l] == UNSEEN ? 0 : T3R_MIN(differ[l] - least, DIFFERS_MOST);
            t3r_label_add(labels, cell, l, t3r_round_shift32(more * weight_q16, 16));
        }
    }
}
