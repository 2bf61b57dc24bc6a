#include "sample_head.h"

#include "unit/unit.h"

static const head_graph sample = {.name = "sample",
                                  .count = 6,
                                  .layers = {{T3R_LAYER_CONV, 1, {0, T3R_SOURCE_NONE}, 9, 6, 6, 2, 1, true},
                                             {T3R_LAYER_DEPTHWISE, 1, {1, T3R_SOURCE_NONE}, 6, 6, 3, 1, 1, false},
                                             {T3R_LAYER_CONV, 2, {2, T3R_SOURCE_NONE}, 6, 5, 4, 2, 1, true},
                                             {T3R_LAYER_CONV, 1, {3, 1}, 11, 7, 3, 1, 1, true},
                                             {T3R_LAYER_POINT, 0, {4, 0}, 16, 10, 1, 1, 4, true},
                                             {T3R_LAYER_POINT, 0, {5, T3R_SOURCE_NONE}, 10, 9, 1, 1, 1, false}}};

static float *numbers(size_t count, uint64_t *seed, double low, double high)
{
    float *out = unit_array(count, sizeof *out);
    for (size_t i = 0; i < count; i++) {
        out[i] = (float)(low + (high - low) * (double)(unit_random(seed) >> 11) * 0x1p-53);
    }
    return out;
}

void sample_head(float_head *head, uint64_t seed)
{
    *head = (float_head){.graph = sample};
    for (uint32_t i = 0; i < sample.count; i++) {
        const head_layer *layer = &sample.layers[i];
        head->layers[i].weight = numbers(head_weight_count(layer), &seed, -0.3, 0.3);
        head->layers[i].bias = numbers(head_bias_count(layer), &seed, -0.5, 0.5);
        head->layers[i].range = i + 1 < sample.count ? numbers(layer->outputs, &seed, 0.5, 4) : NULL;
    }
}
