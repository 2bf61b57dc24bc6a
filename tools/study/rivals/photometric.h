/* SPDX-License-Identifier: Apache-2.0 */
/* The loss that 3D Gaussian Splatting trains with (Kerbl et al. 2023, equation 7): a mix of the mean absolute
 * difference and of one minus the structural similarity. */
#ifndef TRIM3R_TOOLS_RIVALS_PHOTOMETRIC_H
#define TRIM3R_TOOLS_RIVALS_PHOTOMETRIC_H

#include <stdbool.h>
#include <stdint.h>

#define PHOTOMETRIC_SIMILARITY 0.2 /* the share of the second */

/* A target picture, and the parts of the similarity that depend on it alone. */
typedef struct photometric {
    uint32_t width, height;
    float *planes; /* 3 channels x (picture, its mean, the mean of its square); then work */
} photometric;

/* False without memory; photometric_close() in any case. rgb: width x height x 3. */
bool photometric_open(photometric *p, const uint8_t *rgb, uint32_t width, uint32_t height);
void photometric_close(photometric *p);

/* The loss of a picture rgb[width x height x 3] of 0..1, `similarity` the share of the second term; gradient[] gets its
 * derivatives. */
double photometric_loss(const photometric *p, double similarity, const float *rgb, float *gradient);

#endif
