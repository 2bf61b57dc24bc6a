/* The innermost loops of convolutions and point layers: one row of weights against the activations of four pixels,
 * which share the weights' loads (SPEC.md, "Learned head: arithmetic").
 *
 * columns: four times `pitch` activations, of which the first `count` count; sum: the four dot products. The sums of
 * the first two are int32: with int8 activations (in 16 bits here) t3r_weights_check() has bounded them, in every order
 * of summation. The wide ones take int16 activations; they sum T3R_DOT_CHUNK products in int32, then in int64, which is
 * exact in any order. */
#ifndef T3R_KERNEL_DOT_H
#define T3R_KERNEL_DOT_H

#include <stdint.h>

#include "core/little_endian.h"

#define T3R_DOT_PIXELS 4
#define T3R_DOT_CHUNK 256u

void t3r_dot_w8(const int16_t *columns, uint32_t pitch, const int8_t *weights, uint32_t count,
                int32_t sum[T3R_DOT_PIXELS]);
void t3r_dot_w16(const int16_t *columns, uint32_t pitch, const t3r_le16 *weights, uint32_t count,
                 int32_t sum[T3R_DOT_PIXELS]);
void t3r_dot_w8_wide(const int16_t *columns, uint32_t pitch, const int8_t *weights, uint32_t count,
                     int64_t sum[T3R_DOT_PIXELS]);
void t3r_dot_w16_wide(const int16_t *columns, uint32_t pitch, const t3r_le16 *weights, uint32_t count,
                      int64_t sum[T3R_DOT_PIXELS]);

#endif
