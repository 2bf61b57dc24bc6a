/* SPDX-License-Identifier: Apache-2.0 */
/* Colours and widths for which a format of scene files has no numbers. */
#ifndef TRIM3R_TOOLS_SCENE_CUTS_H
#define TRIM3R_TOOLS_SCENE_CUTS_H

#include "scene/scene_extent.h"
#include "scene/scene_format.h"

/* Gaussians that a format changes by more than its steps. */
typedef struct scene_cuts {
    uint32_t colours; /* a colour of degree 0 is outside the format's bounds */
    uint32_t widths;  /* a width is, and changes by more than 1/16 of the Gaussian's largest: thickness rarely does */
} scene_cuts;

/* Counts them. `extent` is that of the rows or a larger one: rows that it keeps within the bounds are not read. */
scene_cuts scene_cuts_of(const scene_format *format, const scene_source *source, const scene_extent *extent);

#endif
