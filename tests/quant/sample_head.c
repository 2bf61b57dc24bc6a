/* SPDX-License-Identifier: Apache-2.0 */
#include "sample_head.h"

#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const head_graph sample = {.name = "sample",
                                  .count = 6,
                                  .layers = {{T3R_LAYER_CONV, 1, {0, T3R_SOURCE_NONE}, 9, 6, 6, 2, 1, true},
                                             {T3R_LAYER_DEPTHWISE, 1, {1, T3R_SOURCE_NONE}, 6, 6, 3, 1, 1, false},
                                             {T3R_LAYER_CONV, 2, {2, T3R_SOURCE_NONE}, 6, 5, 4, 2, 1, true},
                                             {T3R_LAYER_CONV, 1, {3, 1}, 11, 7, 3, 1, 1, true},
                                             {T3R_LAYER_POINT, 0, {4, 0}, 16, 10, 1, 1, 4, true},
                                             {T3R_LAYER_POINT, 0, {5, T3R_SOURCE_NONE}, 10, 9, 1, 1, 1, false}}};

static void *memory(size_t count, size_t bytes)
{
    void *all = calloc(count, bytes);
    if (all == NULL) {
        abort();
    }
    return all;
}

static float *numbers(size_t count, uint64_t *seed, double low, double high)
{
    float *out = memory(count, sizeof *out);
    for (size_t i = 0; i < count; i++) {
        *seed = *seed * UINT64_C(6364136223846793005) + UINT64_C(1442695040888963407);
        out[i] = (float)(low + (high - low) * (double)(*seed >> 11) * 0x1p-53);
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

typedef struct writer {
    FILE *header, *data;
    size_t written; /* bytes of data */
} writer;

static void put_layers(writer *w, const head_graph *graph)
{
    fprintf(w->header,
            "{\"__metadata__\":{\"trim3r\":\"{\\\"format\\\":1,\\\"name\\\":\\\"%s\\\",\\\"feature_set\\\":1,"
            "\\\"layers\\\":[",
            graph->name);
    for (uint32_t i = 0; i < graph->count; i++) {
        const head_layer *l = &graph->layers[i];
        fprintf(w->header, "%s{\\\"kind\\\":\\\"%s\\\",\\\"level\\\":%u,\\\"sources\\\":[%u", i == 0 ? "" : ",",
                head_kind_name(l->kind), (unsigned)l->level, (unsigned)l->sources[0]);
        if (l->sources[1] != T3R_SOURCE_NONE) {
            fprintf(w->header, ",%u", (unsigned)l->sources[1]);
        }
        fprintf(w->header,
                "],\\\"inputs\\\":%u,\\\"outputs\\\":%u,\\\"kernel\\\":%u,\\\"stride\\\":%u,\\\"phases\\\":%u,"
                "\\\"relu\\\":%s}",
                (unsigned)l->inputs, (unsigned)l->outputs, (unsigned)l->kernel, (unsigned)l->stride,
                (unsigned)l->phases, l->relu ? "true" : "false");
    }
    fprintf(w->header, "]}\"}");
}

static void put_tensor(writer *w, uint32_t n, const char *part, const uint32_t *shape, uint32_t rank)
{
    size_t bytes = 4;
    fprintf(w->header, ",\"layer%u.%s\":{\"dtype\":\"F32\",\"shape\":[", (unsigned)n, part);
    for (uint32_t i = 0; i < rank; i++) {
        fprintf(w->header, "%s%u", i == 0 ? "" : ",", (unsigned)shape[i]);
        bytes *= shape[i];
    }
    fprintf(w->header, "],\"data_offsets\":[%zu,%zu]}", w->written, w->written + bytes);
    w->written += bytes;
}

static void put_float(writer *w, float value)
{
    uint32_t bits;
    memcpy(&bits, &value, sizeof bits);
    for (int b = 0; b < 4; b++) {
        fputc((int)(bits >> (8 * b) & 255), w->data);
    }
}

static void put_weight(writer *w, uint32_t n, const head_layer *l, const float *weight)
{
    const bool point = l->kind == T3R_LAYER_POINT;
    const uint32_t fan_in = head_fan_in(l), taps = head_taps(l);
    const uint32_t of_point[3] = {l->phases, l->outputs, l->inputs};
    const uint32_t of_conv[4] = {l->outputs, fan_in, l->kernel, l->kernel};
    put_tensor(w, n, "weight", point ? of_point : of_conv, point ? 3 : 4);
    for (uint32_t i = 0; i < l->outputs * taps * fan_in; i++) {
        uint32_t o = point ? i / fan_in % l->outputs : i / (fan_in * taps);
        uint32_t in = point ? i % fan_in : i / taps % fan_in;
        uint32_t t = point ? i / fan_in / l->outputs : i % taps;
        put_float(w, weight[head_weight_index(l, o, in, t)]);
    }
}

uint8_t *sample_safetensors(const float_head *head, size_t *count)
{
    char *header, *data;
    size_t header_bytes, data_bytes;
    writer w = {.header = open_memstream(&header, &header_bytes), .data = open_memstream(&data, &data_bytes)};
    if (w.header == NULL || w.data == NULL) {
        abort();
    }
    put_layers(&w, &head->graph);
    for (uint32_t n = 1; n <= head->graph.count; n++) {
        const head_layer *l = &head->graph.layers[n - 1];
        const float_layer *from = &head->layers[n - 1];
        const bool point = l->kind == T3R_LAYER_POINT;
        const uint32_t phased[2] = {l->phases, l->outputs};
        put_weight(&w, n, l, from->weight);
        put_tensor(&w, n, "bias", point ? phased : &phased[1], point ? 2 : 1);
        for (size_t i = 0; i < head_bias_count(l); i++) {
            put_float(&w, from->bias[i]);
        }
        if (from->range != NULL) {
            put_tensor(&w, n, "range", &phased[1], 1);
            for (uint32_t o = 0; o < l->outputs; o++) {
                put_float(&w, from->range[o]);
            }
        }
    }
    fputc('}', w.header);
    fclose(w.header);
    fclose(w.data);
    *count = 8 + header_bytes + data_bytes;
    uint8_t *file = memory(*count, 1);
    for (int i = 0; i < 8; i++) {
        file[i] = (uint8_t)((uint64_t)header_bytes >> (8 * i));
    }
    memcpy(file + 8, header, header_bytes);
    memcpy(file + 8 + header_bytes, data, data_bytes);
    free(header);
    free(data);
    return file;
}
