/* Quantizes a float head with ranges (README.md, "Quantization"; runtime/head/weights.h has the arithmetic). */
#ifndef T3R_QUANT_QUANTIZE_H
#define T3R_QUANT_QUANTIZE_H

#include "float_head.h"

typedef struct quantized_layer {
    int16_t *weight; /* in the order of the weight file, |weight| <= 127 or 32767 */
    int64_t *bias;   /* [phases][outputs], zero points folded in */
    int32_t *multiplier;
    int8_t *shift;
    int16_t zero;         /* zero point of the output */
    double *weight_scale; /* [outputs]: a step of the accumulator, in the float head's units */
    double *output_scale; /* [outputs]: a step of the output, likewise */
} quantized_layer;

typedef struct quantized_head {
    head_graph graph;
    uint32_t weight_bits, activation_bits; /* 8 or 16 each */
    quantized_layer layers[T3R_MAX_LAYERS];
} quantized_head;

/* Every layer except the last must have its range. Returns 0, after which quantized_head_free() is due; or -1 with
 * "what, where" in error[]. */
int quantize_head(quantized_head *out, const float_head *head, uint32_t weight_bits, uint32_t activation_bits,
                  char *error, size_t error_bytes);
void quantized_head_free(quantized_head *head);

/* Returns the signal-to-noise ratio of the weights of layer n (from 1) as used in its accumulators, in dB; infinite
 * without noise. */
double quantized_weight_snr(const quantized_head *out, const float_head *head, uint32_t n);

/* Converts scale > 0 to multiplier / 2^31 x 2^shift, like TFLite's QuantizeMultiplier: multiplier in [2^30, 2^31),
 * rounded to nearest. Returns 0, or -1 if shift would leave [-30, 15]. */
int quantize_multiplier(double scale, int32_t *multiplier, int8_t *shift);

/* Returns a step of input i of a layer: the scale of that channel of its source. */
double quantized_input_scale(const quantized_head *head, const head_layer *layer, uint32_t input);

#endif
