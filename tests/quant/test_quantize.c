/* SPDX-License-Identifier: Apache-2.0 */
/* Quantized layers: their distance from the floats; scales and shifts are in range for any weights. */
#include "quantize.h"

#include "sample_head.h"
#include "unit/unit.h"
#include "weight_info.h"

static const uint32_t variants[4][2] = {{8, 8}, {8, 16}, {16, 8}, {16, 16}};

static double multiplier_of(const quantized_layer *layer, uint32_t o)
{
    return ldexp(layer->multiplier[o], layer->shift[o] - 31);
}

/* Asserts that the file passes all checks of a reader: accumulators, multipliers, shifts. */
static void assert_sound(const quantized_head *head)
{
    size_t count;
    weight_info info;
    char error[256] = "";
    uint8_t *file = weight_file_make(head, &count);
    assert_non_null(file);
    if (weight_info_read(&info, file, count, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    free(file);
}

static void quantize(quantized_head *out, const float_head *head, const uint32_t bits[2])
{
    char error[256] = "";
    if (quantize_head(out, head, bits[0], bits[1], error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    assert_sound(out);
}

/* Compares with the definition: the nearest mantissa of 31 bits, at least half of the range. */
TEST(test_multiplier)
{
    uint64_t seed = 1;
    int32_t multiplier;
    int8_t shift;
    for (int i = 0; i < 100000; i++) {
        double scale = ldexp(0.5 + (double)(unit_random(&seed) >> 12) * 0x1p-53, (int)unit_between(&seed, -30, 15));
        assert_int_equal(quantize_multiplier(scale, &multiplier, &shift), 0);
        assert_true(multiplier >= 1 << 30);
        assert_true(shift >= -30 && shift <= 15);
        assert_true(fabs(ldexp(multiplier, shift - 31) - scale) <= ldexp(0.5, shift - 31));
    }
    assert_int_equal(quantize_multiplier(1 - 0x1p-40, &multiplier, &shift), 0);
    assert_int_equal(multiplier, 1 << 30);
    assert_int_equal(shift, 1);
    assert_int_equal(quantize_multiplier(0x1p-31, &multiplier, &shift), 0);
    assert_int_equal(shift, -30);
    assert_int_equal(quantize_multiplier(0x1p-32, &multiplier, &shift), -1);
    assert_int_equal(quantize_multiplier(0x1p15, &multiplier, &shift), -1);
    assert_int_equal(quantize_multiplier(0, &multiplier, &shift), -1);
    assert_int_equal(quantize_multiplier(-1, &multiplier, &shift), -1);
}

/* Every weight and every bias is within half a step, and the multiplier is exactly the ratio of the steps, also in the
 * 16 bits that int16 activations allow. */
TEST(test_layers)
{
    for (uint64_t seed = 0; seed < 5; seed++) {
        for (int v = 0; v < 4; v++) {
            float_head head;
            quantized_head out;
            sample_head(&head, seed);
            quantize(&out, &head, variants[v]);
            for (uint32_t n = 0; n < head.graph.count; n++) {
                const head_layer *layer = &head.graph.layers[n];
                const quantized_layer *to = &out.layers[n];
                bool point = layer->kind == T3R_LAYER_POINT;
                assert_int_equal(to->zero, !layer->relu ? 0 : variants[v][1] == 8 ? -128 : -32768);
                for (uint32_t o = 0; o < layer->outputs; o++) {
                    double step = to->weight_scale[o];
                    assert_true(fabs(multiplier_of(to, o) * to->output_scale[o] / step - 1) < 1e-15);
                    assert_int_equal(to->multiplier[o] & 0xffff, 0);
                    double steps = (variants[v][1] == 8 ? 255 : 65535) / (layer->relu ? 1 : 2);
                    if (n + 1 < head.graph.count) {
                        assert_true(fabs(to->output_scale[o] * steps / (double)head.layers[n].range[o] - 1) < 1e-12);
                    } else {
                        assert_true(to->output_scale[o] * head_output_scale((t3r_head_output)o) == 1);
                    }
                    for (uint32_t t = 0; t < head_taps(layer); t++) {
                        double zeros = 0;
                        for (uint32_t i = 0; i < head_fan_in(layer); i++) {
                            uint32_t input = layer->kind == T3R_LAYER_DEPTHWISE ? o : i;
                            double in = quantized_input_scale(&out, layer, input);
                            size_t at = head_weight_index(layer, o, i, t);
                            double off = to->weight[at] * step / in - (double)head.layers[n].weight[at];
                            assert_true(fabs(off) <= 0.5 * step / in * (1 + 1e-9));
                            uint32_t channel, source = head_input_source(&out.graph, layer, input, &channel);
                            zeros += to->weight[at] * (source == 0 ? 0.0 : out.layers[source - 1].zero);
                        }
                        if (point) {
                            size_t b = (size_t)t * layer->outputs + o;
                            double off = ((double)to->bias[b] + zeros) * step - (double)head.layers[n].bias[b];
                            assert_true(fabs(off) <= 0.5 * step * (1 + 1e-9));
                        }
                    }
                }
                assert_true(quantized_weight_snr(&out, &head, n + 1) > (variants[v][0] == 8 ? 35 : 80));
            }
            quantized_head_free(&out);
            float_head_free(&head);
        }
    }
}

/* Channels that are dead, tiny, huge, or all bias give a valid file or a refusal. */
TEST(test_extremes)
{
    static const float factors[] = {0, 1e-38f, 1e-20f, 1e-6f, 1e6f, 1e20f, 1e38f};
    int refused = 0, made = 0;
    for (int v = 0; v < 4; v++) {
        for (uint32_t n = 0; n < 6; n++) {
            for (size_t w = 0; w < sizeof factors / sizeof *factors; w++) {
                for (size_t b = 0; b < sizeof factors / sizeof *factors; b++) {
                    float_head head;
                    quantized_head out;
                    char error[256] = "";
                    sample_head(&head, w + 10 * b);
                    for (size_t i = 0; i < head_weight_count(&head.graph.layers[n]); i++) {
                        head.layers[n].weight[i] *= factors[w];
                    }
                    head.layers[n].bias[0] *= factors[b];
                    if (n < 5) {
                        head.layers[n].range[0] = factors[(w + b) % 6 + 1];
                    }
                    if (quantize_head(&out, &head, variants[v][0], variants[v][1], error, sizeof error) == 0) {
                        assert_sound(&out);
                        quantized_head_free(&out);
                        made++;
                    } else {
                        assert_non_null(strstr(error, "too large"));
                        assert_null(out.layers[0].weight);
                        refused++;
                    }
                    float_head_free(&head);
                }
            }
        }
    }
    assert_true(made > 500);
    assert_true(refused > 5);
}

/* 16-bit weights and int8 activations: a wide layer would overflow 32 bits at full scale, so it is scaled down. */
TEST(test_accumulators)
{
    float_head head;
    quantized_head out;
    sample_head(&head, 3);
    head_layer *layer = &head.graph.layers[0];
    layer->outputs = head.graph.layers[1].inputs; /* unchanged: 6 outputs of 6 x 6 x 9 inputs */
    for (size_t i = 0; i < head_weight_count(layer); i++) {
        head.layers[0].weight[i] = 0.25f; /* 324 weights at full scale */
    }
    quantize(&out, &head, (const uint32_t[]){16, 8});
    int16_t most = out.layers[0].weight[0];
    assert_true(most < 32767);
    /* |bias'| + 2^8 sum < 2^31 x 7/8, the quantizer's bound: the result is also not far below it */
    assert_in_range(most, 20000, 22700);
    quantized_head_free(&out);
    quantize(&out, &head, (const uint32_t[]){16, 16});
    assert_in_range(out.layers[0].weight[0], 32760, 32767);
    quantized_head_free(&out);
    float_head_free(&head);
}

TEST(test_missing_range)
{
    float_head head;
    quantized_head out;
    char error[256] = "";
    sample_head(&head, 0);
    free(head.layers[2].range);
    head.layers[2].range = NULL;
    assert_int_equal(quantize_head(&out, &head, 8, 8, error, sizeof error), -1);
    assert_non_null(strstr(error, "layer 3 has no range"));
    float_head_free(&head);
}
