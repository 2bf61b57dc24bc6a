/* SPDX-License-Identifier: Apache-2.0 */
/* The picture that a page shows until its own runtime has drawn one. */
#ifndef TRIM3R_TOOLS_VIEWER_FIRST_PICTURE_H
#define TRIM3R_TOOLS_VIEWER_FIRST_PICTURE_H

#include "viewer/bundle.h"

/* Draws the bundle's scene from a camera of its frames' size, at most 320 pixels wide. Returns a PNG on the heap; NULL
 * with *count = 0 when memory is out or the scene cannot be drawn from there. */
uint8_t *first_picture_png(const bundle *data, const t3r_camera *camera, size_t *count);

#endif
