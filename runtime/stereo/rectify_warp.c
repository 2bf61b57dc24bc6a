/* SPDX-License-Identifier: Apache-2.0 */
/* Sampling along the rows of a rectified plane. */
#include "core/fixed.h"
#include "rectify.h"

#define ONE_Q24 (INT64_C(1) << 24)

/* Computes e(row): its parts along y and z, Q24. */
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

/* Sets up a row's rays in the view's frame, as kernels/ray_row.h takes them. */
static void map_row(const t3r_rectification *rect, const t3r_rectified_view *v, uint32_t row, t3r_ray_map *map)
{
    int64_t e[2];
    row_direction(rect, row, e);
    for (int i = 0; i < 3; i++) {
        /* |e| below 2^26.1 in planes, 2^24 in polar ones, where e is a unit vector */
        const int64_t direction = t3r_round_shift64(e[0] * v->turn_q30[3 * i + 1] + e[1] * v->turn_q30[3 * i + 2], 24);
        map->turn_q30[i] = v->turn_q30[3 * i];
        map->slope_q30[i] = rect->polar ? (int32_t)direction : 0;
        map->base_q54[i] = rect->polar ? 0 : direction * ONE_Q24;
    }
}

/* Computes a and b of the rays of columns from x_q16 on; 0 where there is no ray, and after the last. */
static void take_columns(const t3r_rectification *rect, int64_t x_q16, uint32_t count, int32_t a_q24[T3R_RAYS],
                         int32_t b_q24[T3R_RAYS])
{
    for (uint32_t i = 0; i < T3R_RAYS; i++) {
        a_q24[i] = b_q24[i] = 0;
    }
    for (uint32_t i = 0; i < count; i++) {
        const t3r_column c = t3r_rectified_column(rect, (int32_t)(x_q16 + (int64_t)i * 65536));
        const bool any = c.b_q24 > 0;
        a_q24[i] = any ? c.a_q24 : 0;
        b_q24[i] = any && rect->polar ? c.b_q24 : 0; /* b of planar columns is in the map's base */
    }
}

void t3r_rectified_rows(const t3r_kernels *kernels, const t3r_rectification *rect, uint32_t view, const uint8_t *luma,
                        int32_t x_q16, t3r_share rows, uint32_t count, uint8_t *out)
{
    const t3r_rectified_view *v = &rect->view[view];
    const t3r_luma_picture picture = {luma, rect->view_width, rect->view_height};
    t3r_ray_map map = {.steepest = 16, .scale_q16 = {v->fx_q16, v->fy_q16}, .offset_q16 = {v->cx_q16, v->cy_q16}};
    for (uint32_t first = 0; first < count; first += T3R_RAYS) {
        const uint32_t columns = T3R_MIN(count - first, T3R_RAYS);
        int32_t a_q24[T3R_RAYS], b_q24[T3R_RAYS];
        take_columns(rect, x_q16 + (int64_t)first * 65536, columns, a_q24, b_q24);
        for (uint32_t row = rows.begin; row < rows.end; row++) {
            uint8_t *to = out + (size_t)(row - rows.begin) * count + first;
            t3r_ray_places places;
            map_row(rect, v, row, &map);
            kernels->ray_row(&map, a_q24, b_q24, (columns + 15) & ~15u, &places);
            kernels->luma_at(&picture, &places, columns, to);
        }
    }
}
