/* Requantization of an accumulator to an activation: TFLite's single-rounding reference (SPEC.md, "Learned head:
 * arithmetic"). */
#ifndef T3R_KERNEL_REQUANTIZE_H
#define T3R_KERNEL_REQUANTIZE_H

#include <stdint.h>

#include "core/fixed.h"

/* Scaling of one output channel, and the range that its layer is clamped to. */
typedef struct t3r_requantization {
    int32_t multiplier; /* [2^30, 2^31) */
    int32_t shift;      /* -30..15 */
    int32_t zero, low, high;
} t3r_requantization;

/* Requantizes for int8 activations: |acc| < 2^31, so the product is below 2^62. */
static inline int16_t t3r_requantize(int32_t acc, const t3r_requantization *r)
{
    int64_t scaled = t3r_round_shift64((int64_t)acc * r->multiplier, (uint32_t)(31 - r->shift));
    return (int16_t)t3r_clamp64(r->zero + scaled, r->low, r->high);
}

/* Requantizes for int16 activations: |acc| < 2^47, with a multiplier of 15 bits. */
static inline int16_t t3r_requantize_wide(int64_t acc, const t3r_requantization *r)
{
    int64_t multiplier = T3R_MIN(((int64_t)r->multiplier + (1 << 15)) >> 16, (int64_t)INT16_MAX);
    int64_t scaled = t3r_round_shift64(acc * multiplier, (uint32_t)(15 - r->shift));
    return (int16_t)t3r_clamp64(r->zero + scaled, r->low, r->high);
}

#endif
