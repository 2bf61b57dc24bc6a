/* SPDX-License-Identifier: Apache-2.0 */
#include "quantize.h"

#include <math.h>
#include <stdlib.h>

#include "quant_reason.h"

#define LEAST_MULTIPLIER 0x1p-31 /* mantissa 1/2, shift -30 */
#define MOST_MULTIPLIER 0x1p14   /* one octave below the shift's limit, since rounding upwards may take half of it */

int quantize_multiplier(double scale, int32_t *multiplier, int8_t *shift)
{
    int exponent;
    double mantissa = frexp(scale, &exponent);
    int64_t rounded = llround(mantissa * 0x1p31);
    if (rounded == INT64_C(1) << 31) {
        rounded /= 2;
        exponent++;
    }
    if (!(scale > 0) || exponent < -30 || exponent > 15) {
        return -1;
    }
    *multiplier = (int32_t)rounded;
    *shift = (int8_t)exponent;
    return 0;
}

double quantized_input_scale(const quantized_head *head, const head_layer *layer, uint32_t input)
{
    uint32_t channel, source = head_input_source(&head->graph, layer, input, &channel);
    if (source == T3R_SOURCE_FEATURES) {
        return head->activation_bits == 8 ? FLOAT_FEATURE_SCALE : FLOAT_FEATURE_SCALE / 256;
    }
    return head->layers[source - 1].output_scale[channel];
}

typedef struct work {
    quantized_head *out;
    const head_layer *layer;
    const float_layer *from;
    quantized_layer *to;
    double weight_most; /* largest weight */
    double sum_most;    /* of |bias'| + reach x sum |weight|, runtime/head/weights.h */
    double reach;       /* 2^(activation bits - 1) */
} work;

/* Returns the input channel of (output, i): a depthwise output has only its own. */
static uint32_t input_of(const head_layer *layer, uint32_t o, uint32_t i)
{
    return layer->kind == T3R_LAYER_DEPTHWISE ? o : i;
}

static int32_t input_zero(const work *w, uint32_t input)
{
    uint32_t channel, source = head_input_source(&w->out->graph, w->layer, input, &channel);
    return source == T3R_SOURCE_FEATURES ? 0 : w->out->layers[source - 1].zero;
}

/* Returns the index of the bias of (output, phase): one per phase of a point layer, else one. */
static size_t bias_index(const head_layer *layer, uint32_t o, uint32_t phase)
{
    return (size_t)phase * layer->outputs + o;
}

/* Returns the weight with its input's scale folded in. */
static double folded(const work *w, uint32_t o, uint32_t i, uint32_t t)
{
    return w->from->weight[head_weight_index(w->layer, o, i, t)] *
           quantized_input_scale(w->out, w->layer, input_of(w->layer, o, i));
}

/* Computes bounds of an output over its phases: the largest folded weight, and the largest |bias'| + reach x sum
 * |weight|, both in the float head's units. |zero| <= reach, so zero points may double the reach. */
static void measure(const work *w, uint32_t o, double *most, double *sum_most)
{
    const bool point = w->layer->kind == T3R_LAYER_POINT;
    double sum = 0;
    *most = *sum_most = 0;
    for (uint32_t t = 0; t < head_taps(w->layer); t++) {
        sum = point ? 0 : sum;
        for (uint32_t i = 0; i < head_fan_in(w->layer); i++) {
            double amount = fabs(folded(w, o, i, t));
            *most = fmax(*most, amount);
            sum += amount;
        }
        double bias = fabs((double)w->from->bias[bias_index(w->layer, o, point ? t : 0)]);
        *sum_most = fmax(*sum_most, bias + 2 * w->reach * sum);
    }
}

static double output_scale(const work *w, uint32_t o, bool last)
{
    if (last) {
        return 1 / head_output_scale((t3r_head_output)o);
    }
    double steps = ldexp(1, (int)w->out->activation_bits - (w->layer->relu ? 0 : 1)) - 1;
    return w->from->range[o] / steps;
}

/* Returns the least multiplier at or above `scale` with a mantissa of 15 bits, which is also exact with int16
 * activations. */
static double multiplier_above(double scale)
{
    int exponent;
    double mantissa = frexp(scale, &exponent);
    return ldexp(ceil(mantissa * 0x1p15) * 0x1p-15, exponent);
}

/* Chooses the scales of output o. The weights' scale is the smallest that clips no weight, keeps the accumulator within
 * its width and has an exact multiplier, so that requantization adds no error except its rounding. */
static void choose_scales(const work *w, uint32_t o, bool last)
{
    double most, sum_most, to = output_scale(w, o, last);
    measure(w, o, &most, &sum_most);
    double scale = fmax(most / w->weight_most, sum_most / w->sum_most);
    /* if the accumulator would be coarser than 2^14 output steps, make the output coarser instead */
    if (!last) {
        to = fmax(to, scale / MOST_MULTIPLIER);
    }
    scale = fmax(scale, to * LEAST_MULTIPLIER);
    w->to->output_scale[o] = to;
    w->to->weight_scale[o] = multiplier_above(scale / to) * to;
}

static void quantize_weights(const work *w, uint32_t o)
{
    const double scale = w->to->weight_scale[o];
    for (uint32_t t = 0; t < head_taps(w->layer); t++) {
        for (uint32_t i = 0; i < head_fan_in(w->layer); i++) {
            /* clips, since the quotient may exceed the maximum by its last bit */
            double q = round(folded(w, o, i, t) / scale);
            w->to->weight[head_weight_index(w->layer, o, i, t)] =
                (int16_t)fmax(-w->weight_most, fmin(w->weight_most, q));
        }
    }
}

static void quantize_bias(const work *w, uint32_t o)
{
    const bool point = w->layer->kind == T3R_LAYER_POINT;
    for (uint32_t phase = 0; phase < w->layer->phases; phase++) {
        size_t b = bias_index(w->layer, o, phase);
        uint32_t first = point ? phase : 0, end = point ? phase + 1 : head_taps(w->layer);
        int64_t zeros = 0;
        for (uint32_t t = first; t < end; t++) {
            for (uint32_t i = 0; i < head_fan_in(w->layer); i++) {
                zeros += (int64_t)w->to->weight[head_weight_index(w->layer, o, i, t)] *
                         input_zero(w, input_of(w->layer, o, i));
            }
        }
        w->to->bias[b] = llround((double)w->from->bias[b] / w->to->weight_scale[o]) - zeros;
    }
}

static int quantize_layer(quantized_head *out, const float_head *head, uint32_t n, char *error, size_t error_bytes)
{
    const head_layer *layer = &head->graph.layers[n - 1];
    const bool last = n == head->graph.count;
    const uint32_t outputs = layer->outputs;
    quantized_layer *to = &out->layers[n - 1];
    work w = {.out = out,
              .layer = layer,
              .from = &head->layers[n - 1],
              .to = to,
              .weight_most = out->weight_bits == 8 ? 127 : 32767,
              .reach = out->activation_bits == 8 ? 0x1p7 : 0x1p15};
    /* a margin of an eighth: rounding moves every weight by up to half a step and the bias by one */
    w.sum_most = out->activation_bits == 8 ? 0x1p31 * 7 / 8 : 0x1p47 * 7 / 8;
    if (!last && w.from->range == NULL) {
        return quant_reason(error, error_bytes, "layer %u has no range: calibrate", (unsigned)n);
    }
    to->weight = calloc(head_weight_count(layer), sizeof *to->weight);
    to->bias = calloc(head_bias_count(layer), sizeof *to->bias);
    to->multiplier = calloc(outputs, sizeof *to->multiplier);
    to->shift = calloc(outputs, sizeof *to->shift);
    to->weight_scale = calloc(outputs, sizeof *to->weight_scale);
    to->output_scale = calloc(outputs, sizeof *to->output_scale);
    if (to->weight == NULL || to->bias == NULL || to->multiplier == NULL || to->shift == NULL ||
        to->weight_scale == NULL || to->output_scale == NULL) {
        return quant_reason(error, error_bytes, "out of memory");
    }
    to->zero = (int16_t)(layer->relu ? -w.reach : 0);
    for (uint32_t o = 0; o < outputs; o++) {
        choose_scales(&w, o, last);
        if (quantize_multiplier(to->weight_scale[o] / to->output_scale[o], &to->multiplier[o], &to->shift[o]) != 0) {
            return quant_reason(error, error_bytes, "layer %u: weights or biases of output %u are too large",
                                (unsigned)n, (unsigned)o);
        }
        quantize_weights(&w, o);
        quantize_bias(&w, o);
    }
    return 0;
}

int quantize_head(quantized_head *out, const float_head *head, uint32_t weight_bits, uint32_t activation_bits,
                  char *error, size_t error_bytes)
{
    *out = (quantized_head){.graph = head->graph, .weight_bits = weight_bits, .activation_bits = activation_bits};
    for (uint32_t n = 1; n <= head->graph.count; n++) {
        if (quantize_layer(out, head, n, error, error_bytes) != 0) {
            quantized_head_free(out);
            return -1;
        }
    }
    return 0;
}

void quantized_head_free(quantized_head *head)
{
    for (int i = 0; i < T3R_MAX_LAYERS; i++) {
        quantized_layer *layer = &head->layers[i];
        free(layer->weight);
        free(layer->bias);
        free(layer->multiplier);
        free(layer->shift);
        free(layer->weight_scale);
        free(layer->output_scale);
    }
    *head = (quantized_head){0};
}

double quantized_weight_snr(const quantized_head *out, const float_head *head, uint32_t n)
{
    const head_layer *layer = &out->graph.layers[n - 1];
    const quantized_layer *to = &out->layers[n - 1];
    double signal = 0, noise = 0;
    for (uint32_t o = 0; o < layer->outputs; o++) {
        for (uint32_t i = 0; i < head_fan_in(layer); i++) {
            double scale = quantized_input_scale(out, layer, input_of(layer, o, i));
            for (uint32_t t = 0; t < head_taps(layer); t++) {
                size_t at = head_weight_index(layer, o, i, t);
                double exact = head->layers[n - 1].weight[at] * scale;
                double off = to->weight[at] * to->weight_scale[o] - exact;
                signal += exact * exact;
                noise += off * off;
            }
        }
    }
    return 10 * log10(signal / noise);
}
