/* Quality measures of views; a test compares them with an independent implementation. */
#ifndef TRIM3R_TOOLS_METRICS_H
#define TRIM3R_TOOLS_METRICS_H

#include <stdint.h>

/* All images are 8-bit RGB, rows without gaps; mask: one byte a pixel, not 0 = counts; NULL = every pixel. Any size
 * from 1 x 1 is allowed. Every function returns NaN if no pixel counts or memory is out. */
double metric_psnr(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height);
double metric_ssim(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height);
double metric_sharp(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height);
/* Returns the perceived difference, 0 = none: FLIP (Andersson et al. 2020) at 67 pixels a degree, mean over the
 * mask. */
double metric_flip(const uint8_t *target, const uint8_t *render, const uint8_t *mask, uint32_t width, uint32_t height);

#endif
