/* How a view is judged; a scorer that knows nothing of this code gives the same figures in a test. */
#ifndef TRIM3R_TOOLS_METRICS_H
#define TRIM3R_TOOLS_METRICS_H

#include <stdint.h>

/* All images are 8-bit RGB, rows without gaps; mask: one byte a pixel, not 0 = counts; NULL = every pixel.
 * Sizes over which a measure is taken may be any, from 1 x 1. Every function gives NaN where no pixel counts or the
 * host is out of memory. */
double metric_psnr(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height);
double metric_ssim(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height);
double metric_sharp(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height);
/* Perceived difference, 0 = none: FLIP (Andersson et al. 2020) at 67 pixels a degree, mean over the mask. */
double metric_flip(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height);

#endif
