/* Depth of one camera as another one, beside it, would have measured it. */
#ifndef TRIM3R_TOOLS_REGISTER_DEPTH_H
#define TRIM3R_TOOLS_REGISTER_DEPTH_H

#include "import/lens.h"
#include "import/rigid.h"

/* The sides of the registered depth: colour's, divided by the least whole number with which they do not exceed the
 * measured ones. */
void register_depth_size(const t3r_frame *frame, uint32_t *width, uint32_t *height);

/* Fills out (width x height little-endian samples, register_depth_size()) from frame->depth: each sample is a small
 * square at its distance, drawn into the colour camera's picture; the nearest one stays. 0 where nothing was drawn.
 * from_depth: from the depth camera's frame to colour's. False: out of memory. */
bool register_depth(const t3r_frame *frame, const lens *depth, const lens *colour, const rigid *from_depth,
                    uint8_t *out);

#endif
