/* SPDX-License-Identifier: Apache-2.0 */
/* A loss that weights errors of structure, like human vision. */
#ifndef T3R_STRUCTURAL_H
#define T3R_STRUCTURAL_H

#include <stdbool.h>

#include "view_levels.h"

/* Replaces each residual of a drawn tile by 11/16 of itself and 5/16 of the descent direction of structural similarity
 * (Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment", 2004). In a window that direction is the residual
 * minus the window's mean, times 256 / (variance drawn + variance wanted + 64 levels^2). A window is the pixels of 3 x
 * 3 that count and lie in the tile. A pixel takes the mean of its windows. Pixels that do not count may get any value.
 */
void t3r_structural_residuals(t3r_wanted *tile);

/* Weights of a view's residuals. */
typedef struct t3r_structure {
    t3r_view_levels levels; /* differences of level from the other views, which don't count */
    bool contrast;          /* whether structural similarity counts */
} t3r_structure;

void t3r_structural_loss(t3r_wanted *tile, const t3r_structure *structure);

#endif
