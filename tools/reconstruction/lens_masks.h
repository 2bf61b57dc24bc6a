/* SPDX-License-Identifier: Apache-2.0 */
/* Pixels of context views that lie beyond a lens with distortion. They stay black, and no score counts them. */
#ifndef TRIM3R_TOOLS_LENS_MASKS_H
#define TRIM3R_TOOLS_LENS_MASKS_H

#include "reconstruction/reconstruction.h"

/* Finds r->shown[view] as developed_shown() marks it, or leaves it NULL if all pixels count: the frame's camera has no
 * distortion, or no options->min_psnr asks for a score. */
int lens_mask_find(reconstruction *r, const reconstruction_options *options, const char *path, uint32_t view,
                   const t3r_capture_frame *frame);

#endif
