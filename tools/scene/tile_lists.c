#include "scene/tile_lists.h"

#include "kernels/project.h"
#include "raster/raster_splat.h"

static uint32_t tiles_along(uint32_t first, uint32_t last)
{
    return last / T3R_TILE_SIDE - first / T3R_TILE_SIDE + 1;
}

tile_lists tile_lists_of(const t3r_scene *scene, const t3r_camera *camera, uint32_t width, uint32_t height)
{
    tile_lists lists = {0};
    t3r_projection projection;
    if (t3r_projection_make(camera, &scene->frame, width, height, &projection) != T3R_OK) {
        return lists;
    }
    lists.usual = (uint64_t)scene->count * 4 + (uint64_t)width * height;
    for (uint32_t i = 0; i < scene->count; i++) {
        t3r_splat splat;
        if (t3r_project(&projection, &scene->gaussians[i], &splat)) {
            const uint32_t tiles = tiles_along(splat.x0, splat.x1) * tiles_along(splat.y0, splat.y1);
            lists.entries += tiles;
            lists.widest = tiles > lists.widest ? tiles : lists.widest;
        }
    }
    return lists;
}
