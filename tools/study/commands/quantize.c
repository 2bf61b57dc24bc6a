/* SPDX-License-Identifier: Apache-2.0 */
/* trim3r quantize: converts a float head to a weight file. */
#include "study/commands/commands.h"

#include <argp.h>
#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "calibrate.h"
#include "cli/cli.h"
#include "cli/files/whole_file.h"
#include "cli/options/file_options.h"
#include "cli/options/option_values.h"
#include "cli/tables/json_output.h"
#include "float_head.h"
#include "host/file_bytes.h"
#include "quantize.h"
#include "study/commands/calibration_input.h"
#include "trim3r.h"
#include "weight_info.h"
#include "weight_source.h"

#define MOST_FILE_BYTES (256u << 20)
#define PERCENTILE_8_BIT 99.99
/* At 16 bits, twice the largest value seen still gives a finer step than the weights have, so nothing is clipped. */
#define HEADROOM_16_BIT 2.0f

typedef struct options {
    const char *head, *output, *name;
    char **inputs; /* for calibration: at most one per argument */
    uint32_t input_count;
    uint32_t weight_bits, activation_bits, width, height;
    double percentile; /* 0: the default for the activations' width */
    bool json;
} options;

enum { KEY_WEIGHTS = 0x100, KEY_ACTIVATIONS, KEY_CALIBRATE, KEY_PERCENTILE, KEY_SIZE };

static uint32_t option_bits(struct argp_state *state, const char *option, const char *text)
{
    if (strcmp(text, "8") != 0 && strcmp(text, "16") != 0) {
        argp_error(state, "--%s takes 8 or 16, not '%s'", option, text);
    }
    return strcmp(text, "8") == 0 ? 8 : 16;
}

static bool ends_with(const char *path, const char *end)
{
    size_t length = strlen(path), end_length = strlen(end);
    return length > end_length && strcmp(path + length - end_length, end) == 0;
}

static void check_options(struct argp_state *state, const options *o)
{
    char error[128] = "";
    if (o->head == NULL) {
        argp_error(state, "HEAD.safetensors is missing");
    } else if (o->output == NULL) {
        argp_error(state, "-o OUT.t3w or -o OUT.c is missing");
    } else if (!ends_with(o->output, ".t3w") && !ends_with(o->output, ".c")) {
        argp_error(state, "-o takes a name that ends in .t3w or .c, not '%s'", o->output);
    } else if (o->name != NULL && head_name_check(o->name, error, sizeof error) != 0) {
        argp_error(state, "--name: %s", error);
    }
}

static error_t parse_option(int key, char *argument, struct argp_state *state)
{
    options *o = state->input;
    uint32_t count;
    switch (key) {
    case KEY_WEIGHTS:
        o->weight_bits = option_bits(state, "weights", argument);
        return 0;
    case KEY_ACTIVATIONS:
        o->activation_bits = option_bits(state, "activations", argument);
        return 0;
    case KEY_CALIBRATE:
        o->inputs[o->input_count++] = argument;
        return 0;
    case KEY_PERCENTILE:
        option_percents(state, "percentile", argument, &o->percentile, 1, &count);
        return 0;
    case KEY_SIZE:
        option_size(state, "size", argument, T3R_MIN_SIDE, &o->width, &o->height);
        return 0;
    case 'o':
        o->output = argument;
        return 0;
    case ARGP_KEY_ARG:
        if (o->head != NULL && o->input_count > 0) {
            o->inputs[o->input_count++] = argument;
        } else {
            option_argument(state, argument, (const char **[]){&o->head}, 1);
        }
        return 0;
    case ARGP_KEY_END:
        check_options(state, o);
        return 0;
    default:
        return option_field(key, argument, state);
    }
}

static const struct argp_option argp_options[] = {
    OPTION_ARGUMENTS("HEAD.safetensors", OPTION_READS),
    {"output", 'o', "OUT", OPTION_WRITES(FILE_WEIGHTS | FILE_SOURCE),
     "file to write: OUT.t3w, a weight file, or OUT.c, the same as a C array t3r_head_NAME (needed)", 0},
    {"weights", KEY_WEIGHTS, "8|16", 0, "bits of the weights (8)", 0},
    {"activations", KEY_ACTIVATIONS, "8|16", 0, "bits of the activations (8)", 0},
    {"calibrate", KEY_CALIBRATE, "REC.mcap|IMAGE", OPTION_READS,
     "recording or image on which to measure the ranges that the head lacks; more may follow HEAD, or further "
     "--calibrate",
     0},
    {"percentile", KEY_PERCENTILE, "P", 0,
     "percent of an activation's values that its measured range holds (99.99; with 16-bit activations twice the "
     "largest value)",
     0},
    {"size", KEY_SIZE, "WxH", 0, "size to which --calibrate crops and averages images (256x256)", 0},
    {"name", OPTION_TO(options, name), "NAME", 0, "name of the head: 1 to 15 of a-z 0-9 _ (the one in HEAD)", 0},
    {"json", OPTION_TO(options, json), NULL, 0, "print one JSON object on stdout", 0},
    {0},
};

static const struct argp parser = {
    .options = argp_options,
    .parser = parse_option,
    .args_doc = "HEAD.safetensors [REC.mcap|IMAGE...]",
    .doc = "Turn a trained head into integers for the runtime.\v"
           "A head trained for quantization has its ranges "
           "(layerN.range). Missing ones are measured: the float head runs on the runtime's input from the "
           "recordings' context pairs and from images on a plane, with 100, 40, 20, 10 and 5 percent of the points "
           "retained. The same input gives the same file.\n"
           "\n"
           "Examples:\n"
           "  trim3r quantize small.safetensors -o small.t3w\n"
           "  trim3r quantize small.safetensors --calibrate room.mcap \\\n"
           "      --calibrate photo.jpg -o small.t3w\n"
           "  trim3r quantize small.safetensors --weights 16 --activations 16 \\\n"
           "      --name small_w16a16 -o small_w16a16.c",
};

static int read_head(const options *o, float_head *head)
{
    char error[512] = "";
    size_t count;
    uint8_t *bytes = t3r_file_bytes(o->head, MOST_FILE_BYTES, &count, error, sizeof error);
    if (bytes == NULL) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    int failed = float_head_parse(head, bytes, count, error, sizeof error);
    free(bytes);
    if (failed) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", o->head, error);
    }
    if (o->name != NULL) {
        snprintf(head->graph.name, sizeof head->graph.name, "%s", o->name);
    }
    return CLI_OK;
}

/* Returns the first layer without a range, counted from 1; 0 if all have one. */
static uint32_t without_range(const float_head *head)
{
    for (uint32_t n = 1; n < head->graph.count; n++) {
        if (head->layers[n - 1].range == NULL) {
            return n;
        }
    }
    return 0;
}

/* Widens the ranges: those trained for 8 bits clip rare values, which 16 bits can hold. */
static void widen_ranges(float_head *head)
{
    for (uint32_t i = 0; i + 1 < head->graph.count; i++) {
        for (uint32_t o = 0; head->layers[i].range != NULL && o < head->graph.layers[i].outputs; o++) {
            head->layers[i].range[o] *= HEADROOM_16_BIT;
        }
    }
}

/* Calibrates the head; *calibrated is the number of layers whose ranges were measured. */
static int calibrate(const options *o, float_head *head, int *calibrated)
{
    uint32_t lacking = without_range(head);
    *calibrated = 0;
    if (o->activation_bits == 16) {
        widen_ranges(head);
    }
    if (lacking == 0) {
        return CLI_OK;
    }
    if (o->input_count == 0) {
        return cli_error(CLI_BAD_INPUT, "%s: there is no tensor layer%" PRIu32 ".range; --calibrate measures ranges",
                         o->head, lacking);
    }
    calibration *c = calibration_start(head);
    if (c == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    int code = CLI_OK;
    for (uint32_t i = 0; i < o->input_count && code == CLI_OK; i++) {
        code = calibration_input(c, o->inputs[i], o->width, o->height);
    }
    if (code == CLI_OK) {
        bool wide = o->activation_bits == 16 && o->percentile <= 0;
        double percentile = o->percentile > 0 ? o->percentile : wide ? 100 : PERCENTILE_8_BIT;
        *calibrated = calibration_finish(c, head, percentile, wide ? HEADROOM_16_BIT : 1);
        code = *calibrated < 0 ? cli_error(CLI_BAD_INPUT, "out of memory") : CLI_OK;
    }
    calibration_free(c);
    return code;
}

static int write_output(const options *o, const float_head *head, const uint8_t *bytes, size_t count)
{
    t3r_whole_file file;
    char error[512] = "", note[64];
    if (whole_file_begin(&file, o->output, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s", error);
    }
    if (ends_with(o->output, ".c")) {
        snprintf(note, sizeof note, "%u-bit weights, %u-bit activations", (unsigned)o->weight_bits,
                 (unsigned)o->activation_bits);
        weight_source_write(file.stream, head->graph.name, note, bytes, count);
    } else {
        fwrite(bytes, 1, count, file.stream);
    }
    return t3r_whole_file_commit(&file, NULL, error, sizeof error) == 0 ? CLI_OK
                                                                        : cli_error(CLI_BAD_INPUT, "%s", error);
}

static void print_json(const options *o, const weight_info *info, int calibrated, const double *snr)
{
    cJSON *root = cJSON_CreateObject();
    cJSON_AddStringToObject(root, "output", o->output);
    cJSON_AddStringToObject(root, "name", info->graph.name);
    json_add_integer(root, "weight_bits", info->weight_bits);
    json_add_integer(root, "activation_bits", info->activation_bits);
    json_add_integer(root, "bytes", info->bytes);
    cJSON_AddNumberToObject(root, "macs_per_pixel", info->macs_q8 / 256.0);
    json_add_integer(root, "parameters", info->parameters);
    json_add_integer(root, "calibrated_layers", calibrated);
    cJSON *list = cJSON_AddArrayToObject(root, "weight_snr_db");
    for (uint32_t i = 0; i < info->graph.count; i++) {
        cJSON_AddItemToArray(list, isfinite(snr[i]) ? cJSON_CreateNumber(snr[i]) : cJSON_CreateNull());
    }
    json_print(root);
}

static void print_text(const options *o, const weight_info *info, int calibrated, const double *snr)
{
    double least = INFINITY;
    for (uint32_t i = 0; i < info->graph.count; i++) {
        least = fmin(least, snr[i]);
    }
    printf("%s: head %s, %u-bit weights, %u-bit activations, %.1f multiply-accumulates a pixel, %" PRIu32
           " parameters, %" PRIu32 " bytes\n",
           o->output, info->graph.name, (unsigned)info->weight_bits, (unsigned)info->activation_bits,
           info->macs_q8 / 256.0, info->parameters, info->bytes);
    printf("ranges: %d layers measured, %d from the head; weights: at least %.1f dB above their rounding\n", calibrated,
           (int)info->graph.count - 1 - calibrated, least);
}

static int quantize(const options *o, float_head *head)
{
    int calibrated;
    int code = calibrate(o, head, &calibrated);
    if (code != CLI_OK) {
        return code;
    }
    quantized_head quantized;
    char error[512] = "";
    if (quantize_head(&quantized, head, o->weight_bits, o->activation_bits, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", o->head, error);
    }
    double snr[T3R_MAX_LAYERS];
    for (uint32_t n = 1; n <= head->graph.count; n++) {
        snr[n - 1] = quantized_weight_snr(&quantized, head, n);
    }
    size_t count;
    uint8_t *bytes = weight_file_make(&quantized, &count);
    quantized_head_free(&quantized);
    if (bytes == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    weight_info info;
    if (weight_info_read(&info, bytes, count, error, sizeof error) != 0) {
        code = cli_error(CLI_BAD_INPUT, "%s: the weight file that it makes is refused: %s", o->head, error);
    } else {
        code = write_output(o, head, bytes, count);
    }
    free(bytes);
    if (code == CLI_OK && o->json) {
        print_json(o, &info, calibrated, snr);
    } else if (code == CLI_OK) {
        print_text(o, &info, calibrated, snr);
    }
    return code;
}

int command_quantize(int argc, char **argv)
{
    options o = {.weight_bits = 8, .activation_bits = 8, .width = 256, .height = 256};
    o.inputs = calloc((size_t)argc, sizeof *o.inputs);
    if (o.inputs == NULL) {
        return cli_error(CLI_BAD_INPUT, "out of memory");
    }
    file_options_parse(&parser, argc, argv, &o);
    float_head head;
    int code = read_head(&o, &head);
    if (code == CLI_OK) {
        code = quantize(&o, &head);
        float_head_free(&head);
    }
    free(o.inputs);
    return code;
}
