#include "planning/bench_views.h"

#include <stdlib.h>

#include "room/room.h"

#define SEED 1u

bool bench_views_draw(bench_views *views, uint32_t width, uint32_t height, uint32_t count)
{
    const size_t pixels = (size_t)width * height;
    *views = (bench_views){.width = width, .height = height, .count = count};
    for (uint32_t v = 0; v < count; v++) {
        views->rgb[v] = malloc(pixels * 3);
        views->depth[v] = malloc(pixels * 2);
        if (views->rgb[v] == NULL || views->depth[v] == NULL) {
            return false;
        }
        room_camera(2 * v, width, height, &views->camera[v]);
        room_frame(2 * v, width, height, SEED, views->rgb[v], views->depth[v]);
    }
    return true;
}

t3r_status bench_views_add(const bench_views *views, t3r_runtime *runtime)
{
    t3r_status status = t3r_reset(runtime);
    for (uint32_t v = 0; v < views->count && status == T3R_OK; v++) {
        const t3r_frame frame = {
            .format = T3R_PIXEL_RGB24,
            .width = views->width,
            .height = views->height,
            .planes = {views->rgb[v]},
            .stride_bytes = {3 * views->width},
            .depth = (const uint8_t *)views->depth[v], /* for little-endian hosts: times are compared, not bits */
            .depth_width = views->width,
            .depth_height = views->height,
            .depth_stride_bytes = 2 * views->width,
            .depth_unit_q40 = ROOM_DEPTH_UNIT_Q40,
        };
        status = t3r_add_view(runtime, &frame, &views->camera[v]);
    }
    return status;
}

void bench_views_free(bench_views *views)
{
    for (uint32_t v = 0; v < views->count; v++) {
        free(views->rgb[v]);
        free(views->depth[v]);
    }
    *views = (bench_views){0};
}
