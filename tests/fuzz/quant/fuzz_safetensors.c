/* SPDX-License-Identifier: Apache-2.0 */
/* A float head, random or damaged in a few places: refused with a reason, or quantized to a file that its reader
 * accepts, or refused by the quantizer with a reason. */
#include <stdlib.h>
#include <string.h>

#include "quant/sample_head.h"
#include "quantize.h"
#include "safetensors.h"
#include "weight_info.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static void quantize(const float_head *head, uint32_t bits)
{
    quantized_head quantized;
    weight_info info;
    char error[256] = "";
    size_t count;
    if (quantize_head(&quantized, head, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8, error, sizeof error) != 0) {
        if (error[0] == '\0') {
            abort();
        }
        return;
    }
    uint8_t *file = weight_file_make(&quantized, &count);
    /* the only error that requires the whole file */
    if (weight_info_read(&info, file, count, error, sizeof error) != 0 && strstr(error, "over 16 MiB") == NULL) {
        abort();
    }
    free(file);
    quantized_head_free(&quantized);
}

/* Reads every element of every tensor. */
static void read_all(const uint8_t *file, size_t count)
{
    safetensors tensors;
    char error[256] = "";
    if (safetensors_parse(&tensors, file, count, error, sizeof error) != 0) {
        if (error[0] == '\0' || tensors.tensors != NULL) {
            abort();
        }
        return;
    }
    volatile float sum = 0;
    for (uint32_t t = 0; t < tensors.count; t++) {
        for (uint64_t i = 0; i < tensors.tensors[t].elements; i++) {
            sum = sum + safetensors_element(&tensors.tensors[t], i);
        }
    }
    safetensors_free(&tensors);
}

/* data: bits, then damages: two bytes with the place (even: in the header), one with the value. Above 255 the rest is
 * the file. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static uint8_t *sample;
    static size_t sample_bytes, header_bytes;
    if (size == 0) {
        return 0;
    }
    if (sample == NULL) {
        float_head head;
        sample_head(&head, 1);
        sample = sample_safetensors(&head, &sample_bytes);
        header_bytes = 8 + sample[0] + 256u * sample[1];
        float_head_free(&head);
    }
    size_t bytes = data[0] == 255 ? size - 1 : sample_bytes;
    uint8_t *file = malloc(bytes == 0 ? 1 : bytes);
    memcpy(file, data[0] == 255 ? data + 1 : sample, bytes);
    for (size_t i = 1; i + 3 <= size && data[0] != 255; i += 3) {
        size_t at = (size_t)(data[i] | data[i + 1] << 8);
        file[at % 2 == 0 ? at / 2 % header_bytes : at / 2 % bytes] = data[i + 2];
    }
    read_all(file, bytes);
    float_head head;
    char error[256] = "";
    if (float_head_parse(&head, file, bytes, error, sizeof error) == 0) {
        quantize(&head, data[0]);
        float_head_free(&head);
    } else if (error[0] == '\0' || head.layers[0].weight != NULL) {
        abort();
    }
    free(file);
    return 0;
}
