/* Counts the splats that the tiles of a view list, which is the cost of drawing it. A scene of surfaces lists a few
 * tiles per Gaussian. A weight file or a foreign scene can have faint Gaussians as wide as the picture: then every tile
 * lists them all, no pixel ends early, and a view takes hundreds of times as long. */
#ifndef TRIM3R_TOOLS_TILE_LISTS_H
#define TRIM3R_TOOLS_TILE_LISTS_H

#include <stdbool.h>
#include <stdint.h>

#include "trim3r.h"

typedef struct tile_lists {
    uint64_t entries; /* splats of all tiles, at most as many per tile as are drawn */
    uint64_t usual;   /* entries that an arena for full speed holds: four tiles per Gaussian, and one entry per pixel */
    uint32_t widest;  /* tiles of the widest splat */
} tile_lists;

/* Counts for a view of width x height whose tiles draw only the `tile_splats` nearest (0: all); the camera's distortion
 * is ignored. All 0 if it cannot be drawn. False: out of memory. */
bool tile_lists_of(const t3r_scene *scene, const t3r_camera *camera, uint32_t width, uint32_t height,
                   uint32_t tile_splats, tile_lists *lists);

#endif
