/* SPDX-License-Identifier: Apache-2.0 */
/* The runtime's wavelet in a form for tests: all coefficients in Mallat's layout, the inverse, and images that wrap. */
#ifndef T3R_TESTS_WAVELET_PLANES_H
#define T3R_TESTS_WAVELET_PLANES_H

#include <stdint.h>

#include "trim3r.h"

/* Transforms in place to [LL | H; V | D], H high in x, V high in y, the LL quarter split again for the next level.
 * levels: 0..T3R_MAX_LEVELS. The runtime lifts; this function only orders the rows. */
void wavelet_forward(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind);

/* Computes the exact inverse, written from the SPEC line by line. */
void wavelet_inverse(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind);

/* Computes t3r_wavelet_texture() of an image that repeats in both directions, like libraries with a periodic border.
 * Both sides are divisible by 2^levels. */
void wavelet_texture_wrapped(const uint8_t *const colour[3], uint32_t width, uint32_t height, uint32_t levels,
                             t3r_wavelet kind, uint16_t *texture_q4);

#endif
