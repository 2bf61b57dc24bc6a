/* A layer of 8-bit weights and activations for a Cortex-M with sums of two products, four pixels at a time. */
#include "variants.h"

#if defined(T3R_DSP) && T3R_FEATURE_LEARNED

#include <arm_acle.h>

#include "core/fixed.h"
#include "core/little_endian.h"
#include "core/memory.h"

typedef const int16_t *columns[T3R_BLOCK_PIXELS]; /* behind the last pixel, the last again */

/* Two products with activations at x, which is aligned to 4. */
static inline int32_t added(int32_t sum, const int16_t *x, int16x2_t weights)
{
    int16x2_t pair;
    memcpy(&pair, __builtin_assume_aligned(x, 4), sizeof pair);
    return __smlad(pair, weights, sum);
}

static inline void dot(const columns x, const uint8_t *weights, uint32_t taps, int32_t sum[T3R_BLOCK_PIXELS])
{
    const int16_t *x0 = x[0], *x1 = x[1], *x2 = x[2], *x3 = x[3];
    int32_t s0 = sum[0], s1 = sum[1], s2 = sum[2], s3 = sum[3];
    uint32_t left = taps;
    for (; left >= 4; left -= 4, x0 += 4, x1 += 4, x2 += 4, x3 += 4, weights += 4) {
        uint32_t four;
        memcpy(&four, weights, sizeof four);
        const uint32_t even = (uint32_t)__sxtb16((int8x4_t)four), odd = (uint32_t)__sxtb16((int8x4_t)(four >> 8));
        const int16x2_t first = (int16x2_t)((even & 0xffff) | odd << 16),
                        last = (int16x2_t)(even >> 16 | (odd & ~0xffffu));
        s0 = added(added(s0, x0, first), x0 + 2, last);
        s1 = added(added(s1, x1, first), x1 + 2, last);
        s2 = added(added(s2, x2, first), x2 + 2, last);
        s3 = added(added(s3, x3, first), x3 + 2, last);
    }
    for (uint32_t i = 0; i < left; i++) {
        const int32_t w = (int8_t)weights[i];
        s0 += x0[i] * w;
        s1 += x1[i] * w;
        s2 += x2[i] * w;
        s3 += x3[i] * w;
    }
    sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;
}

/* How the sums of an output become activations, by 32-bit shifts alone, exactly: kernels/lanes/packed_scaling.h has the
 * reason. */
typedef struct scaling {
    int32_t multiplier, limit, half, zero;
    uint32_t left, right;
} scaling;

static inline scaling scaling_of(const t3r_convolution *layer, uint32_t output)
{
    const int32_t shift = (int8_t)layer->shift[output];
    const int32_t left = T3R_MAX(shift + 2, 0), right = T3R_MAX(-1 - shift, 1);
    return (scaling){.multiplier = t3r_le_i32(layer->multiplier + (size_t)output * 4),
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
        const int32_t bias = t3r_le_i32(layer->bias + (size_t)output * 4);
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
