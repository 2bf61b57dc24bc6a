/* How many splats the tiles of a view list: what drawing it costs. A scene of surfaces lists a few tiles for each
 * Gaussian. A weight file or a scene from elsewhere can make Gaussians faint and as wide as the picture: then every
 * tile lists them all, nothing ends early, and a view takes hundreds of times as long. */
#ifndef TRIM3R_TOOLS_TILE_LISTS_H
#define TRIM3R_TOOLS_TILE_LISTS_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

typedef struct tile_lists {
    uint64_t entries; /* splats of all tiles, no more of each than are drawn */
    uint64_t usual;   /* what an arena for full speed has room for: four tiles a Gaussian, and one entry a pixel */
    uint32_t widest;  /* tiles of the widest splat */
} tile_lists;

/* Of a view of width x height, of which a tile is drawn from its `tile_splats` nearest alone (0: from all); the
 * camera's distortion is ignored. All 0 where it cannot be drawn. False: out of memory. */
bool tile_lists_of(const t3r_scene *scene, const t3r_camera *camera, uint32_t width, uint32_t height,
                   uint32_t tile_splats, tile_lists *lists);

#endif
