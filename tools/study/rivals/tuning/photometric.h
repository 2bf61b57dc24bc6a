/* SPDX-License-Identifier: Apache-2.0 */
/* The training loss of 3D Gaussian Splatting (Kerbl et al. 2023, equation 7): a mix of the mean absolute difference
 * and one minus the structural similarity. */
#ifndef TRIM3R_TOOLS_RIVALS_PHOTOMETRIC_H
#define TRIM3R_TOOLS_RIVALS_PHOTOMETRIC_H

#include <stdbool.h>
#include <stdint.h>

#define PHOTOMETRIC_SIMILARITY 0.2 /* share of the second term */

/* A target picture, and the parts of the similarity that depend on it alone. */
typedef struct photometric {
    uint32_t width, height;
    float *planes; /* 3 channels x (picture, its mean, the mean of its square); then work */
} photometric;

/* Returns false if out of memory; call photometric_close() in any case. rgb: width x height x 3. */
bool photometric_open(photometric *p, const uint8_t *rgb, uint32_t width, uint32_t height);
void photometric_close(photometric *p);

/* Returns the loss of a picture rgb[width x height x 3] of 0..1; `similarity` is the share of the second term. Stores
 * its derivatives in gradient[]. */
double photometric_loss(const photometric *p, double similarity, const float *rgb, float *gradient);

#endif
