/* Depth of one camera as another one, beside it, would have measured it. */
#ifndef TRIM3R_TOOLS_REGISTER_DEPTH_H
#define TRIM3R_TOOLS_REGISTER_DEPTH_H

#include "import/poses/lens.h"
#include "geometry/rigid.h"

/* The sides of the registered depth: colour's, divided by the least whole number with which they do not exceed the
 * measured ones. */
void register_depth_size(const t3r_frame *frame, uint32_t *width, uint32_t *height);

/* What the corners of a lens' pixels see, for as long as the lens stays. Starts with zeros. */
typedef struct ray_grid {
    float (*rays)[2]; /* (width + 1) x (height + 1) */
    uint32_t width, height;
    const void *of; /* what the lens was read from */
} ray_grid;
/* Makes them for a lens that `of` stands for, where they are not there. false: out of memory. */
bool ray_grid_make(ray_grid *grid, const lens *l, uint32_t width, uint32_t height, const void *of);
void ray_grid_free(ray_grid *grid);

/* Fills out (width x height little-endian samples, register_depth_size()) from frame->depth: each sample is a small
 * square at its distance, drawn into the colour camera's picture; the nearest one stays. 0 where nothing was drawn.
 * rays: of the depth camera's lens. from_depth: from the depth camera's frame to colour's. */
void register_depth(const t3r_frame *frame, const ray_grid *rays, const lens *colour, const rigid *from_depth,
                    uint8_t *out);

#endif
