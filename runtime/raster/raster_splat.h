/* SPDX-License-Identifier: Apache-2.0 */
/* Records and stages of the rasterizer: project, order, bin, blend (SPEC.md, "Raster"). */
#ifndef T3R_RASTER_SPLAT_H
#define T3R_RASTER_SPLAT_H

#include <stdbool.h>
#include <stdint.h>

#include "core/features.h"
#include "core/fixed.h"
#include "kernels/kernels.h"
#include "trim3r.h"

/* z_q20 of the splats of rim and backdrop, once they are ordered. Where such a splat halves the light, the depth is 0:
 * unknown. */
#define T3R_WITHOUT_DEPTH (-1)

/* Pixels of a view that form a smaller picture: columns x, x + 2^spread and so on of rows y, y + 2^spread and so on.
 * spread, x and y are 0 or 1; all 0: every pixel. */
typedef struct t3r_lattice {
    uint32_t spread, x, y;
} t3r_lattice;

/* Returns the lattice; a constant, every pixel, in builds whose passes compare all of them. */
static inline t3r_lattice t3r_lattice_in_use(const t3r_lattice *lattice)
{
    return T3R_FEATURE_PARTS ? *lattice : (t3r_lattice){0, 0, 0};
}

/* Returns the length of a side of that picture: of the width from x on, of the height from y on. */
static inline uint32_t t3r_lattice_side(uint32_t side, uint32_t first, uint32_t spread)
{
    return ((side - first - 1) >> spread) + 1;
}

/* Moves a splat of the whole view to the lattice: its centre into pixels of the view from (x, y) on, its box into those
 * of the picture. A splat whose box has none of them gets z_q20 = 0. */
static inline void t3r_to_lattice(const t3r_lattice *lattice, t3r_splat *s)
{
    const uint32_t spread = lattice->spread, last = (1u << spread) - 1;
    s->x_q12 -= (int32_t)(lattice->x << 12);
    s->y_q12 -= (int32_t)(lattice->y << 12);
    if (s->x1 < lattice->x || s->y1 < lattice->y) {
        s->z_q20 = 0;
        return;
    }
    s->x0 = (uint16_t)((s->x0 + last - T3R_MIN(lattice->x, s->x0 + last)) >> spread);
    s->y0 = (uint16_t)((s->y0 + last - T3R_MIN(lattice->y, s->y0 + last)) >> spread);
    s->x1 = (uint16_t)((s->x1 - lattice->x) >> spread);
    s->y1 = (uint16_t)((s->y1 - lattice->y) >> spread);
    s->z_q20 = s->x0 <= s->x1 && s->y0 <= s->y1 ? s->z_q20 : 0;
}

/* Fills *projection. Returns T3R_ERR_CAMERA when the camera is refused for that size, or out of the scene
 * frame's range. */
t3r_status t3r_projection_make(const t3r_camera *camera, const t3r_scene_frame *frame, uint32_t width, uint32_t height,
                               t3r_projection *projection);

/* Sorts `count` (key, index) pairs of side 0 by key. The sort is stable and takes a pass for each byte in which keys
 * differ. Both sides hold `count` entries. histogram: 4 x 256 counts. Returns the side that holds the result. */
uint32_t t3r_order(const t3r_kernels *kernels, uint32_t *keys[2], uint32_t *indices[2], uint32_t count,
                   uint32_t *histogram);

#endif
