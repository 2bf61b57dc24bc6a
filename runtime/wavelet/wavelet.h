/* Stage wavelet: integer lifting on int16 planes, exactly invertible for any size, and texture energy.
 *
 * A plane's sample is (luma - 128) x 2^T3R_WAVELET_FRACTION with luma = (77 R + 150 G + 29 B + 128) >> 8. No
 * step overflows 16 bits for any image and up to T3R_MAX_LEVELS levels; wavelet_level.h has the proof. */
#ifndef T3R_WAVELET_H
#define T3R_WAVELET_H

#include <stddef.h>
#include <stdint.h>

#include "kernels/kernels.h"
#include "trim3r.h"

#define T3R_WAVELET_FRACTION 4

/* Computes the texture energy of an image: E = sum over levels of |h| + |v| + |d| in orthonormal units of luma, Q4,
 * clamped to 65535. A coefficient of level l covers 2^l x 2^l pixels. plane: width x height; work:
 * T3R_WAVELET_ROW_BYTES(width), aligned for int16_t. */
void t3r_wavelet_texture(const t3r_kernels *kernels, const uint8_t *const colour[3], uint32_t width, uint32_t height,
                         uint32_t levels, t3r_wavelet kind, uint16_t *texture_q4, int16_t *plane, int16_t *work);

#endif
