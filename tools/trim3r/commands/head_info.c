/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r head-info: describes a head. */
#include "trim3r/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "float_head.h"
#include "head/network.h"
#include "host/file_bytes.h"
#include "trim3r.h"
#include "weight_info.h"

#define MOST_FILE_BYTES (256u << 20)

typedef struct options {
    const char *path;
    uint32_t width, height;
    bool json;
} options;

/* A head of either kind of file. */
typedef struct head_summary {
    weight_info info;
    bool is_float;
    bool has_range[T3R_MAX_LAYERS];        /* of a float head */
    size_t work_bytes[T3R_MAX_LAYERS + 1]; /* rows held of the features and of each layer */
    size_t work_total;                     /* including the columns under a kernel */
} head_summary;

enum { KEY_SIZE = 0x100 };

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    options *o = state->input;
    switch (key) {
    case KEY_SIZE:
        option_size(state, "size", argument, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case ARGP_KEY_ARG:
        option_argument(state, argument, (const char **[]){&o->path}, 1);
        return 0;
    case ARGP_KEY_END:
        if (o->path == NULL) {
            argp_error(state, "FILE.t3w or FILE.safetensors is missing");
        }
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("FILE.t3w", OPTION_READS),
    {"size", KEY_SIZE, "WxH", 0, "size of the view that the work bytes are for (256x256)", 0},
    {"json", OPTION_TO(options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "FILE.t3w\nFILE.safetensors",
    .doc = "Show a head's layers: their sources, their channels, multiply-accumulates a pixel with all points kept, "
           "bytes and work bytes; every field of the file is checked.\v"
           "Sources: 0 are the features, n is layer n. "
           "Bytes: weights, biases, multipliers and shifts; of a float head, what they will be with 8-bit weights and "
           "activations. Work bytes: the rows of a layer's output that must be in memory at once when a view goes "
           "through row by row.\n"
           "\n"
           "Examples:\n"
           "  trim3r head-info small.t3w\n"
           "  trim3r head-info small.safetensors --size 96x96\n"
           "  trim3r head-info small.t3w --json",
};

/* Measures the work that the runtime lays out for a file, checked or an outline. */
static void measure_work(head_summary *head, const uint8_t *file, uint32_t width, uint32_t height)
{
    t3r_network network;
    t3r_network_begin(&network, &t3r_kernels_c, file, width, height, 0, NULL, 0);
    for (uint32_t n = 0; n <= network.planes; n++) {
        head->work_bytes[n] = network.nodes[n].pitch * network.nodes[n].ring;
    }
    head->work_total = t3r_network_work_bytes(file, width);
}

static int read_weights(const options *o, head_summary *head, const uint8_t *bytes, size_t count)
{
    char error[512] = "";
    if (weight_info_read(&head->info, bytes, count, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", o->path, error);
    }
    measure_work(head, bytes, o->width, o->height);
    return CLI_OK;
}

static int read_floats(const options *o, head_summary *head, const uint8_t *bytes, size_t count)
{
    char error[512] = "";
    float_head floats;
    if (float_head_parse(&floats, bytes, count, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", o->path, error);
    }
    for (uint32_t i = 0; i < floats.graph.count; i++) {
        head->has_range[i] = floats.layers[i].range != NULL;
    }
    quantized_head outline = {.graph = floats.graph, .weight_bits = 8, .activation_bits = 8};
    float_head_free(&floats);
    weight_info_of_graph(&head->info, &outline.graph, 8, 8);
    uint8_t *file = weight_file_make(&outline, &count);
    if (file == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    measure_work(head, file, o->width, o->height);
    free(file);
    return CLI_OK;
}

static int read_head(const options *o, head_summary *head)
{
    char error[512] = "";
    size_t count;
    uint8_t *bytes = t3r_file_bytes(o->path, MOST_FILE_BYTES, &count, error, sizeof error);
    if (bytes == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    *head = (head_summary){.is_float = count < 4 || memcmp(bytes, "T3RW", 4) != 0};
    int code = head->is_float ? read_floats(o, head, bytes, count) : read_weights(o, head, bytes, count);
    free(bytes);
    return code;
}

static cJSON *layer_json(const head_summary *head, uint32_t n)
{
    const head_layer *layer = &head->info.graph.layers[n - 1];
    cJSON *item = cJSON_CreateObject();
    json_add_integer(item, "layer", n);
    cJSON_AddStringToObject(item, "kind", head_kind_name(layer->kind));
    json_add_integer(item, "level", layer->level);
    json_add_integers(item, "sources", layer->sources, layer->sources[1] == T3R_SOURCE_NONE ? 1 : 2);
    json_add_integer(item, "inputs", layer->inputs);
    json_add_integer(item, "outputs", layer->outputs);
    json_add_integer(item, "kernel", layer->kernel);
    json_add_integer(item, "stride", layer->stride);
    json_add_integer(item, "phases", layer->phases);
    cJSON_AddBoolToObject(item, "relu", layer->relu);
    if (head->is_float) {
        cJSON_AddBoolToObject(item, "has_range", head->has_range[n - 1]);
    }
    cJSON_AddNumberToObject(item, "macs_per_pixel", head_macs_q8(layer) / 256.0);
    json_add_integer(item, "bytes", (int64_t)weight_info_layer_bytes(&head->info, n));
    json_add_integer(item, "work_bytes", (int64_t)head->work_bytes[n]);
    return item;
}

static void print_json(const options *o, const head_summary *head)
{
    const weight_info *info = &head->info;
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "file", o->path);
    cJSON_AddStringToObject(root, "type", head->is_float ? "safetensors" : "t3w");
    cJSON_AddStringToObject(root, "name", info->graph.name);
    json_add_integer(root, "format", T3R_WEIGHTS_FORMAT);
    json_add_integer(root, "feature_set", T3R_FEATURE_SET);
    if (!head->is_float) {
        char crc[9];
        snprintf(crc, sizeof crc, "%08" PRIx32, info->crc);
        json_add_integer(root, "bits_epoch", info->bits_epoch);
        cJSON_AddStringToObject(root, "crc", crc);
    }
    json_add_integer(root, "weight_bits", head->is_float ? 32 : info->weight_bits);
    json_add_integer(root, "activation_bits", head->is_float ? 32 : info->activation_bits);
    json_add_integer(root, "width", o->width);
    json_add_integer(root, "height", o->height);
    cJSON_AddNumberToObject(root, "macs_per_pixel", info->macs_q8 / 256.0);
    json_add_integer(root, "parameters", info->parameters);
    json_add_integer(root, "bytes", info->bytes);
    json_add_integer(root, "feature_work_bytes", (int64_t)head->work_bytes[0]);
    json_add_integer(root, "work_bytes", (int64_t)head->work_total);
    cJSON *layers = cJSON_AddArrayToObject(root, "layers");
    for (uint32_t n = 1; n <= info->graph.count; n++) {
        cJSON_AddItemToArray(layers, layer_json(head, n));
    }
    json_print(root);
}

static void print_row(const head_summary *head, uint32_t n)
{
    const head_layer *layer = &head->info.graph.layers[n - 1];
    char sources[16], shape[24], ranges[8] = "";
    snprintf(sources, sizeof sources, layer->sources[1] == T3R_SOURCE_NONE ? "%u" : "%u,%u",
             (unsigned)layer->sources[0], (unsigned)layer->sources[1]);
    if (layer->kind == T3R_LAYER_POINT) {
        snprintf(shape, sizeof shape, layer->phases == 1 ? "-" : "%u phases", (unsigned)layer->phases);
    } else {
        snprintf(shape, sizeof shape, "%ux%u/%u", (unsigned)layer->kernel, (unsigned)layer->kernel,
                 (unsigned)layer->stride);
    }
    if (head->is_float && n < head->info.graph.count) {
        snprintf(ranges, sizeof ranges, " %s", head->has_range[n - 1] ? "yes" : "no");
    }
    printf("%5u  %-9s  %5u  %-7s  %4u -> %-4u  %-8s  %-6s %10.1f %8zu %9zu%s\n", (unsigned)n,
           head_kind_name(layer->kind), (unsigned)layer->level, sources, (unsigned)layer->inputs,
           (unsigned)layer->outputs, shape, layer->relu ? "relu" : "linear", head_macs_q8(layer) / 256.0,
           weight_info_layer_bytes(&head->info, n), head->work_bytes[n], ranges);
}

static void print_text(const options *o, const head_summary *head)
{
    const weight_info *info = &head->info;
    printf("%s: head %s, ", o->path, info->graph.name);
    if (head->is_float) {
        printf("float\n");
    } else {
        printf("%u-bit weights, %u-bit activations, bits epoch %u, CRC %08" PRIx32 "\n", (unsigned)info->weight_bits,
               (unsigned)info->activation_bits, (unsigned)info->bits_epoch, info->crc);
    }
    printf("%5s  %-9s  %5s  %-7s  %-12s  %-8s  %-6s %10s %8s %9s%s\n", "layer", "kind", "level", "sources", "channels",
           "kernel", "output", "MACs/pixel", "bytes", "work", head->is_float ? " range" : "");
    printf("%5u  %-9s  %5u  %-7s  %12u  %-8s  %-6s %10s %8s %9zu\n", 0u, "features", 0u, "", (unsigned)T3R_FEATURES, "",
           "", "", "", head->work_bytes[0]);
    for (uint32_t n = 1; n <= info->graph.count; n++) {
        print_row(head, n);
    }
    printf("in all: %.1f multiply-accumulates a pixel with all points kept, %" PRIu32 " parameters, %" PRIu32
           " bytes%s, %zu work bytes for %" PRIu32 "x%" PRIu32 "\n",
           info->macs_q8 / 256.0, info->parameters, info->bytes, head->is_float ? " with 8 bits" : "", head->work_total,
           o->width, o->height);
    if (head->is_float) {
        printf("as a weight file (weights, activations):");
        for (int i = 0; i < 4; i++) {
            uint32_t weights = i / 2 == 0 ? 8 : 16, activations = i % 2 == 0 ? 8 : 16;
            printf("%s %zu bytes (%u, %u)", i == 0 ? "" : ",", weight_file_bytes(&info->graph, weights, activations),
                   (unsigned)weights, (unsigned)activations);
        }
        putchar('\n');
    }
}

int command_head_info(int argc, char **argv)
{
    options o = {.width = 256, .height = 256};
    file_options_parse(&parser, argc, argv, &o);
    head_summary head;
    int code = read_head(&o, &head);
    if (code != CLI_OK) {
        return code;
    }
    if (o.json) {
        print_json(&o, &head);
    } else {
        print_text(&o, &head);
    }
    return CLI_OK;
}
