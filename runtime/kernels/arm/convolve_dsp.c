/* SPDX-License-Identifier: Apache-2.0 */
/* A layer of 8-bit weights and activations for a Cortex-M with sums of two products, four pixels at a time. */
#include "variants.h"

#if defined(T3R_DSP) && T3R_FEATURE_LEARNED

#include <arm_acle.h>

#include "core/fixed.h"
#include "core/little_endian.h"

typedef const int16_t *columns[T3R_BLOCK_PIXELS]; /* after the last pixel, the last one repeated */

/* Adds four taps at a time; x is aligned to 4. With intrinsics gcc 12 takes half as many instructions again. */
static inline void dot(const columns x, const uint8_t *weights, uint32_t taps, int32_t sum[T3R_BLOCK_PIXELS])
{
    const int16_t *x0 = x[0], *x1 = x[1], *x2 = x[2], *x3 = x[3];
    const uint8_t *end = weights + (taps & ~3u);
    int32_t s0 = sum[0], s1 = sum[1], s2 = sum[2], s3 = sum[3];
    while (weights != end) {
        uint32_t first, last, rest;
        __asm__(
            "ldr %[rest], [%[weights]], #4\n\t"
            "sxtb16 %[last], %[rest]\n\t"
            "sxtb16 %[rest], %[rest], ror #8\n\t"
            "pkhbt %[first], %[last], %[rest], lsl #16\n\t"
            "pkhtb %[last], %[rest], %[last], asr #16\n\t"
            "ldr %[rest], [%[x0]], #4\n\t"
            "smlad %[s0], %[rest], %[first], %[s0]\n\t"
            "ldr %[rest], [%[x0]], #4\n\t"
            "smlad %[s0], %[rest], %[last], %[s0]\n\t"
            "ldr %[rest], [%[x1]], #4\n\t"
            "smlad %[s1], %[rest], %[first], %[s1]\n\t"
            "ldr %[rest], [%[x1]], #4\n\t"
            "smlad %[s1], %[rest], %[last], %[s1]\n\t"
            "ldr %[rest], [%[x2]], #4\n\t"
            "smlad %[s2], %[rest], %[first], %[s2]\n\t"
            "ldr %[rest], [%[x2]], #4\n\t"
            "smlad %[s2], %[rest], %[last], %[s2]\n\t"
            "ldr %[rest], [%[x3]], #4\n\t"
            "smlad %[s3], %[rest], %[first], %[s3]\n\t"
            "ldr %[rest], [%[x3]], #4\n\t"
            "smlad %[s3], %[rest], %[last], %[s3]"
            : [first] "=&r"(first), [last] "=&r"(last), [rest] "=&r"(rest), [weights] "+r"(weights), [x0] "+r"(x0),
              [x1] "+r"(x1), [x2] "+r"(x2), [x3] "+r"(x3), [s0] "+r"(s0), [s1] "+r"(s1), [s2] "+r"(s2), [s3] "+r"(s3)
            :
            : "memory");
    }
    for (uint32_t i = 0; i < taps % 4; i++) {
        const int32_t w = (int8_t)weights[i];
        s0 += x0[i] * w;
        s1 += x1[i] * w;
        s2 += x2[i] * w;
        s3 += x3[i] * w;
    }
    sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;
}

/* Scaling of an output's sums by 32-bit shifts only, exactly: kernels/lanes/packed_scaling.h has the reason. */
typedef struct scaling {
    int32_t multiplier, limit, half, zero;
    uint32_t left, right;
} scaling;

static inline scaling scaling_of(const t3r_convolution *layer, uint32_t output)
{
    const int32_t shift = (int8_t)layer->shift[output];
    const int32_t left = T3R_MAX(shift + 2, 0), right = T3R_MAX(-1 - shift, 1);
    return (scaling){.multiplier = (int32_t)t3r_load_le32(layer->multiplier + (size_t)output * 4),
                     .limit = left > 0 ? 1 << (18 - shift) : INT32_MAX,
                     .half = 1 << (right - 1),
                     .zero = layer->zero,
                     .left = (uint32_t)left,
                     .right = (uint32_t)right};
}

static inline int32_t scaled(int32_t sum, const scaling *s)
{
    sum = t3r_clamp32(sum, -s->limit, s->limit) * (1 << s->left);
    const int32_t high = (int32_t)(((int64_t)sum * s->multiplier) >> 32);
    return ((high + s->half) >> s->right) + s->zero;
}

void t3r_convolve_dsp(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    if (layer->activation_bits != 8 || layer->weight_bits != 8) {
        t3r_convolve_c(layer, block, out, out_pitch);
        return;
    }
    columns x;
    for (uint32_t i = 0; i < T3R_BLOCK_PIXELS; i++) {
        x[i] = (const int16_t *)block->x + (size_t)T3R_MIN(i, block->pixels - 1) * block->step;
    }
    for (uint32_t output = 0; output < layer->outputs; output++) {
        const int32_t bias = (int32_t)t3r_load_le32(layer->bias + (size_t)output * 4);
        const scaling s = scaling_of(layer, output);
        int32_t sum[T3R_BLOCK_PIXELS] = {bias, bias, bias, bias};
        dot(x, layer->weights + (size_t)output * layer->taps, layer->taps, sum);
        for (uint32_t i = 0; i < block->pixels; i++) {
            const size_t at = (size_t)i * out_pitch + output;
            if (layer->output_bits == 8) {
                ((int8_t *)out)[at] = (int8_t)__ssat(scaled(sum[i], &s), 8);
            } else {
                ((int16_t *)out)[at] = (int16_t)__ssat(scaled(sum[i], &s), 16);
            }
        }
    }
}

#else
typedef int t3r_no_convolve_dsp; /* a file may not be empty */
#endif
