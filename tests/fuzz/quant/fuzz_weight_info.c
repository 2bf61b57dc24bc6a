/* SPDX-License-Identifier: Apache-2.0 */
/* A weight file, random or damaged in a few places, with a valid checksum. The firmware's and the host's rules for
 * layers accept the same files, and a refusal has a reason. */
#include <stdlib.h>
#include <string.h>

#include "quant/sample_head.h"
#include "weight_info.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

static uint8_t *sample_file(uint32_t bits, size_t *count)
{
    float_head head;
    quantized_head quantized;
    sample_head(&head, bits);
    if (quantize_head(&quantized, &head, bits & 1 ? 16 : 8, bits & 2 ? 16 : 8, NULL, 0) != 0) {
        abort();
    }
    uint8_t *file = weight_file_make(&quantized, count);
    quantized_head_free(&quantized);
    float_head_free(&head);
    return file;
}

/* data: bits, then damages: two bytes with the place (even: in header and table), one with the value. Above 255 the
 * rest is the file. */
int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size)
{
    static uint8_t *samples[4];
    static size_t sample_bytes[4];
    if (size == 0) {
        return 0;
    }
    uint32_t bits = data[0] & 3;
    if (samples[bits] == NULL) {
        samples[bits] = sample_file(bits, &sample_bytes[bits]);
    }
    const size_t bytes = data[0] == 255 ? size - 1 : sample_bytes[bits];
    const size_t table = T3R_WEIGHTS_HEADER_BYTES + 6 * T3R_WEIGHTS_LAYER_BYTES;
    void *memory;
    if (posix_memalign(&memory, T3R_WEIGHTS_ALIGN, bytes == 0 ? 1 : bytes) != 0) {
        return 0;
    }
    uint8_t *file = memory;
    memcpy(file, data[0] == 255 ? data + 1 : samples[bits], bytes);
    for (size_t i = 1; i + 3 <= size && data[0] != 255; i += 3) {
        size_t at = (size_t)(data[i] | data[i + 1] << 8);
        file[at % 2 == 0 ? at / 2 % table : at / 2 % bytes] = data[i + 2];
    }
    if (bytes >= T3R_WEIGHTS_HEADER_BYTES) {
        weight_file_seal(file, bytes);
    }
    weight_info info;
    char error[256] = "";
    bool taken = weight_info_read(&info, file, bytes, error, sizeof error) == 0;
    if (taken != (t3r_weights_check(file, bytes) == T3R_OK) || taken != (error[0] == '\0')) {
        abort();
    }
    free(file);
    return 0;
}
