/* SPDX-License-Identifier: Apache-2.0 */
#include "stream_discs.h"

#include "core/fixed.h"
#include "pointmap/reproject.h"

#define RADIUS_SPACINGS_Q4 32 /* radius of a Gaussian's disc: two spacings, */
#define RADIUS_MOST T3R_MAP_MARGIN

/* Returns the disc around a pixel of the wide picture at depth z, without its surface. */
static t3r_map_disc disc_at(const t3r_pointmap *keyframe, const t3r_map_record *record, uint32_t u, uint32_t v,
                            int32_t z_q20)
{
    const t3r_view *view = keyframe->view;
    const int32_t density_q10 = record->density_q10 + 8 * (t3r_grain_q8(view, z_q20) - record->grain_q8);
    const int32_t log_spacing_q10 = t3r_clamp32(-density_q10 / 2, -2048, 4096);
    const int32_t radius_q4 = (int32_t)(t3r_exp2_q16(log_spacing_q10 * 64) * RADIUS_SPACINGS_Q4 >> 16);
    const int32_t held_q4 = T3R_MIN(radius_q4, RADIUS_MOST << 4);
    const int64_t f_q16 = ((int64_t)view->fx_q16 + view->fy_q16) / 2;
    const int64_t off_q20 = ((int64_t)z_q20 * held_q4 << 12) / f_q16 + z_q20 / 16; /* 2^31 x 2^8 x 2^12 */
    const uint32_t nearest = t3r_depth_steps(keyframe->scale, (uint32_t)T3R_MAX(z_q20 - off_q20, 0));
    const uint32_t farthest = t3r_depth_steps(keyframe->scale, (uint32_t)T3R_MIN(z_q20 + off_q20, INT32_MAX));
    return (t3r_map_disc){
        .u = (int16_t)((int32_t)u - RADIUS_MOST),
        .v = (int16_t)((int32_t)v - RADIUS_MOST),
        .radius_q4 = (uint16_t)held_q4,
        .nearest = (uint16_t)T3R_MAX(nearest, 1u),
        .farthest = (uint16_t)farthest,
        .density_q10 = density_q10,
    };
}

t3r_disc_shape t3r_disc_shape_of(const t3r_map_disc *disc)
{
    t3r_disc_shape shape = {.radius = disc->radius_q4 >> 4};
    int32_t half = shape.radius;
    for (int32_t y = 0; y <= shape.radius; y++) {
        while ((half * half + y * y) * 256 > disc->radius_q4 * disc->radius_q4) {
            half--;
        }
        shape.half[y] = (uint8_t)half;
    }
    return shape;
}

/* Returns the size of the disc's surface in pixels. Outside the picture it goes on. */
static uint16_t surface_of(const t3r_view *view, const t3r_map_disc *disc)
{
    const t3r_disc_shape shape = t3r_disc_shape_of(disc);
    uint32_t outside = 0, on = 0;
    for (int32_t y = -shape.radius; y <= shape.radius; y++) {
        const t3r_disc_row r = t3r_disc_row_of(view, disc, &shape, y);
        outside += r.pixels - r.inside;
        for (uint32_t x = 0; x < r.inside; x++) {
            on += t3r_is_on_disc(view, disc, r.first + x);
        }
    }
    return (uint16_t)(on > 0 ? outside + on : 0); /* at most 33 x 33 */
}

typedef struct discs_job {
    const t3r_map *map;
    const t3r_pointmap *keyframe;
    t3r_map_disc *discs;
} discs_job;

static void find_some(void *context, uint32_t begin, uint32_t end, uint32_t worker)
{
    (void)worker;
    const discs_job *job = context;
    const t3r_pinhole wide = t3r_map_wide_picture(job->keyframe->view);
    for (uint32_t i = begin; i < end; i++) {
        int32_t z_q20;
        const uint32_t pixel = t3r_locate_point(&wide, job->map->gaussians[i].position_q20, &z_q20);
        if (pixel == T3R_NO_PIXEL) {
            job->discs[i] = (t3r_map_disc){0};
            continue;
        }
        t3r_map_disc disc =
            disc_at(job->keyframe, &job->map->records[i], pixel % wide.width, pixel / wide.width, z_q20);
        disc.surface = surface_of(job->keyframe->view, &disc);
        job->discs[i] = disc;
    }
}

void t3r_map_discs_find(const t3r_map *map, const t3r_pointmap *keyframe, const t3r_workers *workers,
                        t3r_map_disc *discs)
{
    discs_job job = {.map = map, .keyframe = keyframe, .discs = discs};
    t3r_run_rows(workers, map->count, find_some, &job);
}
