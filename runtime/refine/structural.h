/* A loss that sees structure, as eyes do. */
#ifndef T3R_STRUCTURAL_H
#define T3R_STRUCTURAL_H

#include <stdbool.h>

#include "view_levels.h"

/* What a drawn tile lacks becomes 11/16 of it and 5/16 of what structural similarity asks for. That one's descent
 * (Wang, Bovik, Sheikh and Simoncelli, "Image quality assessment", 2004) takes from each window's residuals their mean
 * and divides by the contrast in it: 256 / (variance drawn + variance wanted + 64 levels^2). Windows are of 3 x 3
 * pixels, of those that count and lie in the tile; a pixel takes the mean of the windows that it lies in. Pixels that
 * do not count keep anything. */
void t3r_structural_residuals(t3r_wanted *tile);

/* What of a view's residuals counts. */
typedef struct t3r_structure {
    t3r_view_levels levels; /* that the view shows beyond the others count for nothing */
    bool contrast;          /* structural similarity counts, too */
} t3r_structure;

void t3r_structural_loss(t3r_wanted *tile, const t3r_structure *structure);

#endif
