/* SPDX-License-Identifier: Apache-2.0 */
/* The harmonics of a SOG to write: a palette of coefficients, and an entry for each Gaussian. */
#ifndef TRIM3R_TOOLS_SOG_HARMONICS_H
#define TRIM3R_TOOLS_SOG_HARMONICS_H

#include "scene/formats/sog/codebook.h"
#include "scene/formats/sog/webp_texels.h"
#include "scene/scene_rows.h"

typedef struct sog_harmonics {
    uint32_t count;                   /* entries of the palette */
    webp_texels centroids;            /* palette: a texel per coefficient, whose bytes are indices into the codebook */
    webp_texels labels;               /* a texel per Gaussian: its palette entry in 16 bits */
    double codebook[CODEBOOK_VALUES]; /* ascending */
} sog_harmonics;

/* Makes the harmonics of a source of degree 1..3 whose Gaussians are in `order`; labels get this width and height.
 * Returns 0, or -1 without memory; call sog_harmonics_free() in either case. */
int sog_harmonics_make(const scene_source *source, const uint32_t *order, uint32_t width, uint32_t height,
                       sog_harmonics *out);
void sog_harmonics_free(sog_harmonics *made);

#endif
