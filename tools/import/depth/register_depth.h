/* SPDX-License-Identifier: Apache-2.0 */
/* Converts the depth of one camera to the depth that another camera next to it would have measured. */
#ifndef TRIM3R_TOOLS_REGISTER_DEPTH_H
#define TRIM3R_TOOLS_REGISTER_DEPTH_H

#include "geometry/rigid.h"
#include "import/poses/lens.h"

/* Computes the sides of the registered depth: colour's, divided by the least integer that makes them no larger than the
 * measured ones. */
void register_depth_size(const t3r_frame *frame, uint32_t *width, uint32_t *height);

/* The rays of the corners of a lens's pixels, kept as long as the lens stays the same. Initialise with zeros. */
typedef struct ray_grid {
    float (*rays)[2]; /* (width + 1) x (height + 1) */
    uint32_t width, height;
    const void *of; /* what the lens was read from */
} ray_grid;
/* Makes the rays of a lens, identified by `of`, unless they are there already. false: out of memory. */
bool ray_grid_make(ray_grid *grid, const lens *l, uint32_t width, uint32_t height, const void *of);
void ray_grid_free(ray_grid *grid);

/* Fills out (width x height little-endian samples, register_depth_size()) from frame->depth: each sample is a small
 * square at its distance, drawn into the colour camera's picture; the nearest one wins. 0 where nothing was drawn.
 * rays: of the depth camera's lens. from_depth: from the depth camera's frame to colour's. */
void register_depth(const t3r_frame *frame, const ray_grid *rays, const lens *colour, const rigid *from_depth,
                    uint8_t *out);

#endif
