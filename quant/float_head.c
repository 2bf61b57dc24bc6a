/* SPDX-License-Identifier: Apache-2.0 */
#include "float_head.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include <cjson/cJSON.h>

#include "json_object.h"
#include "quant_reason.h"
#include "safetensors.h"

#define METADATA_KEY "trim3r"
#define FORMAT 1

typedef struct reader {
    const safetensors *file;
    uint32_t n; /* the layer's number */
    char *error;
    size_t error_bytes;
} reader;

static int fail(const reader *r, const char *field, const char *what)
{
    return r->n == 0 ? quant_reason(r->error, r->error_bytes, METADATA_KEY ": %.32s: %s", field, what)
                     : quant_reason(r->error, r->error_bytes, "layer %u: %.32s: %s", (unsigned)r->n, field, what);
}

/* Refuses unknown keys, which are probably misspelt. */
static int check_keys(const reader *r, const cJSON *object, const char *const *known, size_t count)
{
    const cJSON *item;
    cJSON_ArrayForEach(item, object)
    {
        size_t i = 0;
        while (i < count && strcmp(item->string, known[i]) != 0) {
            i++;
        }
        if (i == count) {
            return fail(r, item->string, "unknown");
        }
    }
    return 0;
}

/* Reads 0..65535; `absent` if missing, unless that is negative. */
static int read_number(const reader *r, const cJSON *object, const char *key, int absent, uint32_t *value)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, key);
    if (item == NULL && absent >= 0) {
        *value = (uint32_t)absent;
        return 0;
    }
    if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble <= 65535) ||
        floor(item->valuedouble) != item->valuedouble) {
        return fail(r, key, item == NULL ? "missing" : "not a whole number 0..65535");
    }
    *value = (uint32_t)item->valuedouble;
    return 0;
}

static int read_kind(const reader *r, const cJSON *object, t3r_layer_kind *kind)
{
    const cJSON *item = cJSON_GetObjectItemCaseSensitive(object, "kind");
    for (int i = 0; i < T3R_LAYER_KINDS && cJSON_IsString(item); i++) {
        if (strcmp(item->valuestring, head_kind_name((t3r_layer_kind)i)) == 0) {
            *kind = (t3r_layer_kind)i;
            return 0;
        }
    }
    return fail(r, "kind", item == NULL ? "missing" : "not one of conv, depthwise, point");
}

static int read_sources(const reader *r, const cJSON *object, uint32_t sources[2])
{
    const cJSON *list = cJSON_GetObjectItemCaseSensitive(object, "sources"), *item;
    int count = 0;
    sources[0] = sources[1] = T3R_SOURCE_NONE;
    if (!cJSON_IsArray(list)) {
        return fail(r, "sources", list == NULL ? "missing" : "not an array");
    }
    cJSON_ArrayForEach(item, list)
    {
        if (count == 2) {
            return fail(r, "sources", "more than two");
        }
        if (!cJSON_IsNumber(item) || !(item->valuedouble >= 0 && item->valuedouble < r->n) ||
            floor(item->valuedouble) != item->valuedouble) {
            return fail(r, "sources", "not 0 (features) or the number of a layer before");
        }
        sources[count++] = (uint32_t)item->valuedouble;
    }
    return count > 0 ? 0 : fail(r, "sources", "empty");
}

static int read_layer(const reader *r, const cJSON *object, head_layer *layer)
{
    static const char *const keys[] = {"kind",   "level",  "sources", "inputs", "outputs",
                                       "kernel", "stride", "phases",  "relu"};
    if (!cJSON_IsObject(object)) {
        return fail(r, "it", "not an object");
    }
    if (check_keys(r, object, keys, sizeof keys / sizeof *keys) != 0 || read_kind(r, object, &layer->kind) != 0) {
        return -1;
    }
    int one = layer->kind == T3R_LAYER_POINT ? 1 : -1;
    if (read_number(r, object, "level", layer->kind == T3R_LAYER_POINT ? 0 : -1, &layer->level) != 0 ||
        read_sources(r, object, layer->sources) != 0 || read_number(r, object, "inputs", -1, &layer->inputs) != 0 ||
        read_number(r, object, "outputs", -1, &layer->outputs) != 0 ||
        read_number(r, object, "kernel", one, &layer->kernel) != 0 ||
        read_number(r, object, "stride", one, &layer->stride) != 0 ||
        read_number(r, object, "phases", 1, &layer->phases) != 0) {
        return -1;
    }
    const cJSON *relu = cJSON_GetObjectItemCaseSensitive(object, "relu");
    layer->relu = cJSON_IsTrue(relu);
    return cJSON_IsBool(relu) ? 0 : fail(r, "relu", relu == NULL ? "missing" : "not true or false");
}

static int read_description(reader *r, const cJSON *root, head_graph *graph)
{
    static const char *const keys[] = {"format", "name", "feature_set", "layers"};
    uint32_t format, feature_set;
    if (check_keys(r, root, keys, sizeof keys / sizeof *keys) != 0 ||
        read_number(r, root, "format", -1, &format) != 0 ||
        read_number(r, root, "feature_set", -1, &feature_set) != 0) {
        return -1;
    }
    if (format != FORMAT) {
        return fail(r, "format", "not 1");
    }
    if (feature_set != T3R_FEATURE_SET) {
        return fail(r, "feature_set", "not 1");
    }
    const cJSON *name = cJSON_GetObjectItemCaseSensitive(root, "name");
    if (!cJSON_IsString(name)) {
        return fail(r, "name", name == NULL ? "missing" : "not a string");
    }
    if (head_name_check(name->valuestring, r->error, r->error_bytes) != 0) {
        return -1;
    }
    snprintf(graph->name, sizeof graph->name, "%s", name->valuestring);
    const cJSON *layers = cJSON_GetObjectItemCaseSensitive(root, "layers"), *item;
    if (!cJSON_IsArray(layers)) {
        return fail(r, "layers", layers == NULL ? "missing" : "not an array");
    }
    cJSON_ArrayForEach(item, layers)
    {
        if (graph->count == T3R_MAX_LAYERS) {
            r->n = 0;
            return fail(r, "layers", "more than 24");
        }
        r->n = ++graph->count;
        if (read_layer(r, item, &graph->layers[r->n - 1]) != 0) {
            return -1;
        }
    }
    return head_graph_check(graph, r->error, r->error_bytes);
}

static int read_graph(reader *r, head_graph *graph)
{
    const char *text = safetensors_metadata(r->file, METADATA_KEY);
    if (text == NULL) {
        return quant_reason(r->error, r->error_bytes, "__metadata__ has no \"" METADATA_KEY "\": not a head of trim3r");
    }
    cJSON *root = json_object_parse(METADATA_KEY, text, strlen(text), r->error, r->error_bytes);
    int status = root == NULL ? -1 : read_description(r, root, graph);
    cJSON_Delete(root);
    return status;
}

/* Finds the tensor "layerN.part" of the shape; NULL with a reason, or without one if it is optional and absent. */
static const safetensors_tensor *find(const reader *r, const char *part, const uint32_t *shape, uint32_t rank,
                                      bool optional, int *status)
{
    char name[32];
    snprintf(name, sizeof name, "layer%u.%s", (unsigned)r->n, part);
    const safetensors_tensor *tensor = safetensors_find(r->file, name);
    *status = 0;
    if (tensor == NULL) {
        *status = optional ? 0 : fail(r, part, "the tensor is missing");
        return NULL;
    }
    bool same = tensor->rank == rank;
    for (uint32_t i = 0; same && i < rank; i++) {
        same = tensor->shape[i] == shape[i];
    }
    for (uint64_t i = 0; same && i < tensor->elements; i++) {
        if (!isfinite(safetensors_element(tensor, i))) {
            *status = fail(r, part, "holds a number that is not finite");
            return NULL;
        }
    }
    *status = same ? 0 : fail(r, part, "the tensor's shape is not the layer's");
    return same ? tensor : NULL;
}

/* Copies a tensor unchanged; NULL in *out if it is absent. */
static int copy(const reader *r, const char *part, const uint32_t *shape, uint32_t rank, bool optional, float **out)
{
    int status;
    const safetensors_tensor *tensor = find(r, part, shape, rank, optional, &status);
    *out = NULL;
    if (tensor == NULL) {
        return status;
    }
    *out = malloc((size_t)tensor->elements * sizeof **out);
    for (uint64_t i = 0; *out != NULL && i < tensor->elements; i++) {
        (*out)[i] = safetensors_element(tensor, i);
    }
    return *out != NULL ? 0 : quant_reason(r->error, r->error_bytes, "out of memory");
}

static int read_weight(const reader *r, const head_layer *layer, float **out)
{
    const uint32_t fan_in = head_fan_in(layer), taps = head_taps(layer);
    const uint32_t point[3] = {layer->phases, layer->outputs, layer->inputs};
    const uint32_t conv[4] = {layer->outputs, fan_in, layer->kernel, layer->kernel};
    bool is_point = layer->kind == T3R_LAYER_POINT;
    float *given;
    if (copy(r, "weight", is_point ? point : conv, is_point ? 3 : 4, false, &given) != 0) {
        return -1;
    }
    *out = malloc(head_weight_count(layer) * sizeof **out);
    for (uint32_t o = 0; *out != NULL && o < layer->outputs; o++) {
        for (uint32_t i = 0; i < fan_in; i++) {
            for (uint32_t t = 0; t < taps; t++) {
                size_t from =
                    is_point ? ((size_t)t * layer->outputs + o) * fan_in + i : ((size_t)o * fan_in + i) * taps + t;
                (*out)[head_weight_index(layer, o, i, t)] = given[from];
            }
        }
    }
    free(given);
    return *out != NULL ? 0 : quant_reason(r->error, r->error_bytes, "out of memory");
}

static int read_tensors(const reader *r, const head_layer *layer, float_layer *out, uint32_t *tensors)
{
    const uint32_t phased[2] = {layer->phases, layer->outputs};
    bool is_point = layer->kind == T3R_LAYER_POINT;
    if (read_weight(r, layer, &out->weight) != 0 ||
        copy(r, "bias", is_point ? phased : &phased[1], is_point ? 2 : 1, false, &out->bias) != 0 ||
        copy(r, "range", &layer->outputs, 1, true, &out->range) != 0) {
        return -1;
    }
    for (uint32_t o = 0; out->range != NULL && o < layer->outputs; o++) {
        if (!(out->range[o] > 0)) {
            return fail(r, "range", "holds a number that is not positive");
        }
    }
    *tensors += out->range != NULL ? 3 : 2;
    return 0;
}

int float_head_parse(float_head *head, const void *bytes, size_t count, char *error, size_t error_bytes)
{
    safetensors file;
    uint32_t tensors = 0;
    *head = (float_head){0};
    if (safetensors_parse(&file, bytes, count, error, error_bytes) != 0) {
        return -1;
    }
    reader r = {.file = &file, .error = error, .error_bytes = error_bytes};
    int status = read_graph(&r, &head->graph);
    for (r.n = 1; r.n <= head->graph.count && status == 0; r.n++) {
        status = read_tensors(&r, &head->graph.layers[r.n - 1], &head->layers[r.n - 1], &tensors);
    }
    if (status == 0 && tensors != file.count) {
        status = quant_reason(error, error_bytes, "%u tensors belong to no layer", (unsigned)(file.count - tensors));
    }
    safetensors_free(&file);
    if (status != 0) {
        float_head_free(head);
    }
    return status;
}

void float_head_free(float_head *head)
{
    for (int i = 0; i < T3R_MAX_LAYERS; i++) {
        free(head->layers[i].weight);
        free(head->layers[i].bias);
        free(head->layers[i].range);
    }
    *head = (float_head){0};
}
