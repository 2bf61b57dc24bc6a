/* SPDX-License-Identifier: Apache-2.0 */
/* A layer of 8-bit weights and activations, four pixels at a time, in vectors of Helium. */
#include "variants.h"

#if defined(T3R_MVE) && T3R_FEATURE_LEARNED

#include <arm_mve.h>
#include <stdbool.h>

#include "core/fixed.h"
#include "core/little_endian.h"

/* A column for each pixel; after the last pixel, the last one repeated. */
typedef struct columns {
    const int16_t *x[T3R_BLOCK_PIXELS];
} columns;

/* Adds an output's products, eight taps at a time. With intrinsics gcc 12 keeps sums in memory. */
static inline int32x4_t dot(const columns *c, const uint8_t *weights, uint32_t taps)
{
    const int16_t *x0 = c->x[0], *x1 = c->x[1], *x2 = c->x[2], *x3 = c->x[3];
    int32_t s0 = 0, s1 = 0, s2 = 0, s3 = 0;
    __asm__("dlstp.16 lr, %[taps]\n"
            "1:\n\t"
            "vldrb.s16 q0, [%[weights]], #8\n\t"
            "vldrh.u16 q1, [%[x0]], #16\n\t"
            "vmlava.s16 %[s0], q0, q1\n\t"
            "vldrh.u16 q2, [%[x1]], #16\n\t"
            "vmlava.s16 %[s1], q0, q2\n\t"
            "vldrh.u16 q1, [%[x2]], #16\n\t"
            "vmlava.s16 %[s2], q0, q1\n\t"
            "vldrh.u16 q2, [%[x3]], #16\n\t"
            "vmlava.s16 %[s3], q0, q2\n\t"
            "letp lr, 1b"
            : [weights] "+l"(weights), [x0] "+r"(x0), [x1] "+r"(x1), [x2] "+r"(x2), [x3] "+r"(x3), [s0] "+Te"(s0),
              [s1] "+Te"(s1), [s2] "+Te"(s2), [s3] "+Te"(s3)
            : [taps] "r"(taps)
            : "lr", "q0", "q1", "q2", "memory");
    const int32x4_t low = vsetq_lane_s32(s1, vdupq_n_s32(s0), 1);
    return vsetq_lane_s32(s3, vsetq_lane_s32(s2, low, 2), 3);
}

/* Scales sums to activations by 32-bit shifts only, exactly: kernels/lanes/packed_scaling.h has the reason. */
static inline int32x4_t scaled(int32x4_t sum, const t3r_convolution *layer, uint32_t output)
{
    const int32_t shift = (int8_t)layer->shift[output];
    const int32_t left = T3R_MAX(shift + 2, 0), right = T3R_MAX(-1 - shift, 1);
    if (left > 0) {
        const int32_t limit = 1 << (18 - shift);
        sum = vmaxq_s32(vminq_s32(sum, vdupq_n_s32(limit)), vdupq_n_s32(-limit));
        sum = vshlq_r_s32(sum, left);
    }
    const int32x4_t multiplier = vdupq_n_s32((int32_t)t3r_load_le32(layer->multiplier + (size_t)output * 4));
    return vaddq_n_s32(vrshlq_n_s32(vmulhq_s32(sum, multiplier), -right), layer->zero);
}

void t3r_convolve_mve(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    if (layer->activation_bits != 8 || layer->weight_bits != 8) {
        t3r_convolve_c(layer, block, out, out_pitch);
        return;
    }
    columns c;
    for (uint32_t i = 0; i < T3R_BLOCK_PIXELS; i++) {
        c.x[i] = (const int16_t *)block->x + (size_t)T3R_MIN(i, block->pixels - 1) * block->step;
    }
    const mve_pred16_t there = vctp32q(block->pixels);
    const uint32x4_t place = vmulq_n_u32(vidupq_n_u32(0, 1), out_pitch);
    for (uint32_t output = 0; output < layer->outputs; output++) {
        int32x4_t sum = dot(&c, layer->weights + (size_t)output * layer->taps, layer->taps);
        sum = scaled(vaddq_n_s32(sum, (int32_t)t3r_load_le32(layer->bias + (size_t)output * 4)), layer, output);
        if (layer->output_bits == 8) {
            sum = vmaxq_s32(vminq_s32(sum, vdupq_n_s32(INT8_MAX)), vdupq_n_s32(INT8_MIN));
            vstrbq_scatter_offset_p_s32((int8_t *)out + output, place, sum, there);
        } else {
            sum = vmaxq_s32(vminq_s32(sum, vdupq_n_s32(INT16_MAX)), vdupq_n_s32(INT16_MIN));
            vstrhq_scatter_shifted_offset_p_s32((int16_t *)out + output, place, sum, there);
        }
    }
}

#else
typedef int t3r_no_convolve_mve; /* a file may not be empty */
#endif
