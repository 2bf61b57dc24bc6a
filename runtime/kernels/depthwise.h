/* The innermost loops of depthwise layers: sum[c] = sum over taps of column[t][c] x weights[t][c], one pixel.
 *
 * 32-bit sums: with int8 activations t3r_weights_check() has bounded them; with int8 weights 25 x 2^15 x 2^7. */
#ifndef T3R_KERNEL_DEPTHWISE_H
#define T3R_KERNEL_DEPTHWISE_H

#include <stdint.h>

#include "core/little_endian.h"

void t3r_depthwise_w8(const int16_t *column, const int8_t *weights, uint32_t taps, uint32_t channels, int32_t *sum);
void t3r_depthwise_w16(const int16_t *column, const t3r_le16 *weights, uint32_t taps, uint32_t channels, int32_t *sum);
/* int16 activations and weights */
void t3r_depthwise_w16_wide(const int16_t *column, const t3r_le16 *weights, uint32_t taps, uint32_t channels,
                            int64_t *sum);

#endif
