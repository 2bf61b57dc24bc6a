#include "kernels/convolve.h"

#include <stdbool.h>
#include <stddef.h>

#include "core/fixed.h"
#include "core/little_endian.h"
#include "kernels/requantize.h"

#define CHUNK 256u /* products of 16-bit activations summed in 32 bits */

/* Four sums over one run of weights: 16-bit factors and 32-bit sums, which compilers turn into one instruction (SSE2
 * pmaddwd, NEON smlal). */
#define DOT(WEIGHT)                                                                                                    \
    const int16_t *x0 = x[0], *x1 = x[1], *x2 = x[2], *x3 = x[3];                                                      \
    int32_t s0 = 0, s1 = 0, s2 = 0, s3 = 0;                                                                            \
    for (uint32_t i = 0; i < count; i++) {                                                                             \
        int16_t w = (int16_t)(WEIGHT);                                                                                 \
        s0 += x0[i] * w;                                                                                               \
        s1 += x1[i] * w;                                                                                               \
        s2 += x2[i] * w;                                                                                               \
        s3 += x3[i] * w;                                                                                               \
    }                                                                                                                  \
    sum[0] = s0, sum[1] = s1, sum[2] = s2, sum[3] = s3;

typedef const int16_t *const four_columns[T3R_BLOCK_PIXELS];

static void dot_w8(four_columns x, const int8_t *weights, uint32_t count, int32_t sum[T3R_BLOCK_PIXELS])
{
    DOT(weights[i])
}

static void dot_w16(four_columns x, const t3r_le16 *weights, uint32_t count, int32_t sum[T3R_BLOCK_PIXELS])
{
    DOT(t3r_from_le16(weights[i]))
}

static void dot_high(four_columns x, const t3r_le16 *weights, uint32_t count, int32_t sum[T3R_BLOCK_PIXELS])
{
    DOT(t3r_from_le16(weights[i]) >> 8)
}

static void dot_low(four_columns x, const t3r_le16 *weights, uint32_t count, int32_t sum[T3R_BLOCK_PIXELS])
{
    DOT(t3r_from_le16(weights[i]) & 255)
}

static void dot_w8_wide(four_columns x, const int8_t *weights, uint32_t count, int64_t sum[T3R_BLOCK_PIXELS])
{
    sum[0] = sum[1] = sum[2] = sum[3] = 0;
    for (uint32_t at = 0; at < count; at += CHUNK) {
        four_columns part_x = {x[0] + at, x[1] + at, x[2] + at, x[3] + at};
        int32_t part[T3R_BLOCK_PIXELS]; /* at most 256 x 2^15 x 2^7 = 2^30 */
        dot_w8(part_x, weights + at, T3R_MIN(count - at, CHUNK), part);
        for (int i = 0; i < T3R_BLOCK_PIXELS; i++) {
            sum[i] += part[i];
        }
    }
}

/* weight = 256 high + low, low in 0..255: two sums that fit 32 bits, of 256 x 2^15 x 2^7 = 2^30 and 256 x 2^15 x 255 <
 * 2^31 at most. */
static void dot_w16_wide(four_columns x, const t3r_le16 *weights, uint32_t count, int64_t sum[T3R_BLOCK_PIXELS])
{
    sum[0] = sum[1] = sum[2] = sum[3] = 0;
    for (uint32_t at = 0; at < count; at += CHUNK) {
        four_columns part_x = {x[0] + at, x[1] + at, x[2] + at, x[3] + at};
        uint32_t length = T3R_MIN(count - at, CHUNK);
        int32_t high[T3R_BLOCK_PIXELS], low[T3R_BLOCK_PIXELS];
        dot_high(part_x, weights + at, length, high);
        dot_low(part_x, weights + at, length, low);
        for (int i = 0; i < T3R_BLOCK_PIXELS; i++) {
            sum[i] += (int64_t)high[i] * 256 + low[i];
        }
    }
}

/* Computes an output's sums over four columns, without the bias. Columns are padded with zeros, so the loop may run
 * over the padding as long as weights may be read there: their values don't matter. */
static void dot(const t3r_convolution *layer, four_columns x, uint32_t output, int64_t sum[T3R_BLOCK_PIXELS])
{
    const uint32_t taps = layer->taps, whole = (taps + T3R_COLUMN_TAPS - 1) / T3R_COLUMN_TAPS * T3R_COLUMN_TAPS;
    const uint32_t bytes = layer->weight_bits / 8, at = output * taps * bytes;
    const uint32_t count = layer->readable - at >= whole * bytes ? whole : taps;
    const int8_t *w8 = (const int8_t *)layer->weights + at;
    const t3r_le16 *w16 = (const t3r_le16 *)(const void *)(layer->weights + at);
    if (layer->activation_bits == 16) {
        if (bytes == 1) {
            dot_w8_wide(x, w8, count, sum);
        } else {
            dot_w16_wide(x, w16, count, sum);
        }
        return;
    }
    int32_t narrow_sum[T3R_BLOCK_PIXELS];
    if (bytes == 1) {
        dot_w8(x, w8, count, narrow_sum);
    } else {
        dot_w16(x, w16, count, narrow_sum);
    }
    for (int i = 0; i < T3R_BLOCK_PIXELS; i++) {
        sum[i] = narrow_sum[i];
    }
}

static t3r_requantization requantization_of(const t3r_convolution *layer, uint32_t output)
{
    return (t3r_requantization){
        .multiplier = (int32_t)t3r_load_le32(layer->multiplier + (size_t)output * 4),
        .shift = (int8_t)layer->shift[output],
        .zero = layer->zero,
        .low = layer->output_bits == 8 ? INT8_MIN : INT16_MIN,
        .high = layer->output_bits == 8 ? INT8_MAX : INT16_MAX,
    };
}

/* Adds the output's bias to its sum of products and writes the activation to out[at]. */
static void finish(const t3r_convolution *layer, uint32_t output, const t3r_requantization *r, int64_t sum, void *out,
                   size_t at)
{
    int16_t activation;
    if (layer->activation_bits == 16) {
        activation = t3r_requantize_wide((int64_t)t3r_load_le64(layer->bias + (size_t)output * 8) + sum, r);
    } else {
        activation = t3r_requantize((int32_t)((int32_t)t3r_load_le32(layer->bias + (size_t)output * 4) + sum), r);
    }
    if (layer->output_bits == 8) {
        ((int8_t *)out)[at] = (int8_t)activation;
    } else {
        ((int16_t *)out)[at] = activation;
    }
}

void t3r_convolve_c(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    const int16_t *first = block->x;
    const uint32_t last = block->pixels - 1; /* pads by repeating the last pixel */
    four_columns x = {first, first + (size_t)T3R_MIN(1, last) * block->step,
                      first + (size_t)T3R_MIN(2, last) * block->step, first + (size_t)T3R_MIN(3, last) * block->step};
    for (uint32_t output = 0; output < layer->outputs; output++) {
        int64_t sum[T3R_BLOCK_PIXELS];
        dot(layer, x, output, sum);
        const t3r_requantization r = requantization_of(layer, output);
        for (uint32_t i = 0; i <= last; i++) {
            finish(layer, output, &r, sum[i], out, (size_t)i * out_pitch + output);
        }
    }
}

/* --- depthwise: an output sums only its own channel -------------------------------------------------------------- */

/* sum[c] = sum over taps of column[t][c] x weights[t][c]. 32-bit sums: t3r_weights_check() has bounded them with 8-bit
 * activations; with 8-bit weights they are at most 25 x 2^15 x 2^7. */
#define DEPTHWISE(WEIGHT)                                                                                              \
    for (uint32_t c = 0; c < channels; c++) {                                                                          \
        sum[c] = 0;                                                                                                    \
    }                                                                                                                  \
    for (uint32_t t = 0; t < taps; t++, column += channels, weights += channels) {                                     \
        for (uint32_t c = 0; c < channels; c++) {                                                                      \
            sum[c] += column[c] * (WEIGHT);                                                                            \
        }                                                                                                              \
    }

static void depthwise_w8(const int16_t *column, const int8_t *weights, uint32_t taps, uint32_t channels, int32_t *sum)
{
    DEPTHWISE(weights[c])
}

static void depthwise_w16(const int16_t *column, const t3r_le16 *weights, uint32_t taps, uint32_t channels,
                          int32_t *sum)
{
    DEPTHWISE(t3r_from_le16(weights[c]))
}

static void depthwise_w16_wide(const int16_t *column, const t3r_le16 *weights, uint32_t taps, uint32_t channels,
                               int64_t *sum)
{
    DEPTHWISE(t3r_from_le16(weights[c])) /* a product is at most 2^30 */
}

void t3r_depthwise_c(const t3r_convolution *layer, const t3r_block *block, void *out, uint32_t out_pitch)
{
    const uint32_t channels = layer->outputs, taps = layer->taps;
    const bool is_wide = layer->activation_bits == 16 && layer->weight_bits == 16;
    const int8_t *w8 = (const int8_t *)layer->weights;
    const t3r_le16 *w16 = (const t3r_le16 *)(const void *)layer->weights;
    int32_t sum[T3R_LAYER_OUTPUTS];
    int64_t wide[T3R_LAYER_OUTPUTS];
    for (uint32_t i = 0; i < block->pixels; i++) {
        const int16_t *column = (const int16_t *)block->x + (size_t)i * block->step;
        if (is_wide) {
            depthwise_w16_wide(column, w16, taps, channels, wide);
        } else if (layer->weight_bits == 16) {
            depthwise_w16(column, w16, taps, channels, sum);
        } else {
            depthwise_w8(column, w8, taps, channels, sum);
        }
        for (uint32_t c = 0; c < channels; c++) {
            const t3r_requantization r = requantization_of(layer, c);
            finish(layer, c, &r, is_wide ? wide[c] : sum[c], out, (size_t)i * out_pitch + c);
        }
    }
}
