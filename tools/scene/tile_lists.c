#include "scene/tile_lists.h"

#include <stdlib.h>

#include "kernels/project.h"
#include "raster/raster_splat.h"

/* Splats per tile as differences: the corners of each splat's rectangle add or subtract one. Sums over rows and columns
 * are the counts; one more column and row hold the far corners. */
typedef struct tile_counts {
    int64_t *change;
    uint32_t across, down; /* with the extra one */
} tile_counts;

static void add_splat(tile_counts *counts, const t3r_splat *splat, tile_lists *lists)
{
    const uint32_t x0 = splat->x0 / T3R_TILE_SIDE, x1 = splat->x1 / T3R_TILE_SIDE + 1;
    const uint32_t y0 = splat->y0 / T3R_TILE_SIDE, y1 = splat->y1 / T3R_TILE_SIDE + 1;
    const uint32_t tiles = (x1 - x0) * (y1 - y0);
    lists->widest = tiles > lists->widest ? tiles : lists->widest;
    counts->change[y0 * counts->across + x0]++;
    counts->change[y0 * counts->across + x1]--;
    counts->change[y1 * counts->across + x0]--;
    counts->change[y1 * counts->across + x1]++;
}

static uint64_t sum(tile_counts *counts, uint32_t tile_splats)
{
    uint64_t entries = 0;
    for (uint32_t y = 0; y < counts->down; y++) {
        for (uint32_t x = 0; x < counts->across; x++) {
            int64_t *here = counts->change + y * counts->across + x;
            *here += (x > 0 ? here[-1] : 0) + (y > 0 ? here[-(int64_t)counts->across] : 0) -
                     (x > 0 && y > 0 ? here[-1 - (int64_t)counts->across] : 0);
            entries += tile_splats > 0 && *here > (int64_t)tile_splats ? tile_splats : (uint64_t)*here;
        }
    }
    return entries;
}

bool tile_lists_of(const t3r_scene *scene, const t3r_camera *camera, uint32_t width, uint32_t height,
                   uint32_t tile_splats, tile_lists *lists)
{
    *lists = (tile_lists){0};
    t3r_projection projection;
    if (t3r_projection_make(camera, &scene->frame, width, height, &projection) != T3R_OK) {
        return true;
    }
    tile_counts counts = {.across = (width - 1) / T3R_TILE_SIDE + 2, .down = (height - 1) / T3R_TILE_SIDE + 2};
    counts.change = calloc((size_t)counts.across * counts.down, sizeof *counts.change);
    if (counts.change == NULL) {
        return false;
    }
    lists->usual = (uint64_t)scene->count * 4 + (uint64_t)width * height;
    for (uint32_t i = 0; i < scene->count; i++) {
        t3r_splat splat;
        if (t3r_project(&projection, &scene->gaussians[i], &splat)) {
            add_splat(&counts, &splat, lists);
        }
    }
    lists->entries = sum(&counts, tile_splats);
    free(counts.change);
    return true;
}
