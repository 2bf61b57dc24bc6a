/* Records and stages of the rasterizer: project, order, bin, blend (SPEC.md, "Raster"). */
#ifndef T3R_RASTER_SPLAT_H
#define T3R_RASTER_SPLAT_H

#include <stdbool.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "trim3r.h"

/* Fills *projection. Returns T3R_ERR_CAMERA when the camera is out of the scene frame's range. */
t3r_status t3r_projection_make(const t3r_camera *camera, const t3r_scene_frame *frame, uint32_t width, uint32_t height,
                               t3r_projection *projection);

/* Sorts `count` (key, index) pairs of side 0 by key. The sort is stable and takes a pass for each byte in which keys
 * differ. Both sides hold `count` entries. histogram: 4 x 256 counts. Returns the side that holds the result. */
uint32_t t3r_order(const t3r_kernels *kernels, uint32_t *keys[2], uint32_t *indices[2], uint32_t count,
                   uint32_t *histogram);

#endif
