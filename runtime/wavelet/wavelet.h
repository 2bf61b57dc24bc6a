/* Stage wavelet: integer lifting on int16 planes, exactly invertible for any size, and texture energy.
 *
 * A plane's sample is (luma - 128) x 2^T3R_WAVELET_FRACTION with luma = (77 R + 150 G + 29 B + 128) >> 8. No
 * step overflows 16 bits for any image and up to T3R_MAX_LEVELS levels: the proof stands in wavelet.c. */
#ifndef T3R_WAVELET_H
#define T3R_WAVELET_H

#include <stddef.h>
#include <stdint.h>

#include "trim3r.h"

#define T3R_WAVELET_FRACTION 4

/* How samples beyond the border are made. */
typedef enum t3r_wavelet_border {
    T3R_WAVELET_SYMMETRIC, /* by the nearest samples, as wavelet_level.h and the SPEC say; any size */
    T3R_WAVELET_PERIODIC   /* wraps; sizes divisible by 2^levels only: for comparison with other libraries */
} t3r_wavelet_border;

/* Bytes of `work` below, aligned for int16_t: at most (width + height) x 16 from T3R_MIN_SIDE on. */
size_t t3r_wavelet_work_bytes(uint32_t width, uint32_t height);

/* In place to Mallat's layout [LL | H; V | D], H high in x, V high in y, the LL quarter split again for the next
 * level. levels 0..T3R_MAX_LEVELS; a side of length 1 passes through. */
void t3r_wavelet_forward(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                         int16_t *work);
/* The exact inverse of t3r_wavelet_forward() with the same arguments. */
void t3r_wavelet_inverse(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                         int16_t *work);

/* Texture energy of an image: E = sum over levels of |h| + |v| + |d| in orthonormal units of luma, Q4, a
 * coefficient of level l covering its 2^l x 2^l pixels; clamped to 65535. plane: width x height of work. */
void t3r_wavelet_texture(const uint8_t *const colour[3], uint32_t width, uint32_t height, uint32_t levels,
                         t3r_wavelet kind, uint16_t *texture_q4, int16_t *plane, int16_t *work);

/* The same with a choice of border (tests). */
void t3r_wavelet_forward_border(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                                t3r_wavelet_border border, int16_t *work);
void t3r_wavelet_inverse_border(int16_t *plane, uint32_t width, uint32_t height, uint32_t levels, t3r_wavelet kind,
                                t3r_wavelet_border border, int16_t *work);
void t3r_wavelet_texture_border(const uint8_t *const colour[3], uint32_t width, uint32_t height, uint32_t levels,
                                t3r_wavelet kind, t3r_wavelet_border border, uint16_t *texture_q4, int16_t *plane,
                                int16_t *work);

#endif
