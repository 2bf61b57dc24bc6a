/* SPDX-License-Identifier: Apache-2.0 */
/* Weight files: a change in any field of a valid file is refused with a reason by the host's reader, and also by the
 * runtime's check. */
#include "weight_info.h"

#include "core/little_endian.h"
#include "sample_head.h"
#include "unit/unit.h"

typedef struct sample_file {
    uint8_t *bytes; /* aligned to 16, of exactly count bytes */
    size_t count;
} sample_file;

static sample_file copy_of(const uint8_t *bytes, size_t count)
{
    sample_file file = {.count = count};
    assert_int_equal(posix_memalign((void **)&file.bytes, T3R_WEIGHTS_ALIGN, count == 0 ? 1 : count), 0);
    memcpy(file.bytes, bytes, count);
    return file;
}

static sample_file make(uint32_t weight_bits, uint32_t activation_bits)
{
    float_head head;
    quantized_head quantized;
    sample_file file;
    sample_head(&head, 7);
    assert_int_equal(quantize_head(&quantized, &head, weight_bits, activation_bits, NULL, 0), 0);
    uint8_t *bytes = weight_file_make(&quantized, &file.count);
    assert_non_null(bytes);
    file = copy_of(bytes, file.count);
    free(bytes);
    quantized_head_free(&quantized);
    float_head_free(&head);
    return file;
}

static void seal(const sample_file *file)
{
    weight_file_seal(file->bytes, file->count);
}

static void refuse(const sample_file *file, const char *why)
{
    weight_info info;
    char error[256] = "";
    int status = weight_info_read(&info, file->bytes, file->count, error, sizeof error);
    if (status != -1 || strstr(error, why) == NULL) {
        fail_msg("%d: '%s' does not say '%s'", status, error, why);
    }
    assert_int_equal(t3r_weights_check(file->bytes, file->count), T3R_ERR_WEIGHTS);
}

/* Refuses the sample with a number of `bytes` bytes at `at` changed, with a matching CRC. */
static void refuse_change(uint32_t weight_bits, uint32_t activation_bits, size_t at, uint32_t bytes, uint64_t value,
                          const char *why)
{
    sample_file file = make(weight_bits, activation_bits);
    uint8_t before[8];
    memcpy(before, file.bytes + at, bytes);
    weight_number_put(file.bytes + at, (int64_t)value, bytes);
    assert_memory_not_equal(file.bytes + at, before, bytes);
    seal(&file);
    refuse(&file, why);
    free(file.bytes);
}

static void refuse_header(size_t at, uint32_t bytes, uint64_t value, const char *why)
{
    refuse_change(8, 8, at, bytes, value, why);
}

/* Refuses a field of layer n, from 1; the reason does not name the layer. */
static void refuse_row(uint32_t n, size_t at, uint32_t bytes, uint64_t value, const char *why)
{
    refuse_header(T3R_WEIGHTS_HEADER_BYTES + (n - 1) * (size_t)T3R_WEIGHTS_LAYER_BYTES + at, bytes, value, why);
}

/* Refuses a field of a layer that the reason names. */
static void refuse_layer(uint32_t n, size_t at, uint32_t bytes, uint64_t value, const char *why)
{
    char text[128];
    snprintf(text, sizeof text, "layer %u: %s", (unsigned)n, why);
    refuse_row(n, at, bytes, value, text);
}

TEST(test_reads)
{
    static const uint32_t variants[4][2] = {{8, 8}, {8, 16}, {16, 8}, {16, 16}};
    for (int v = 0; v < 4; v++) {
        sample_file file = make(variants[v][0], variants[v][1]);
        weight_info info, outline;
        char error[256] = "";
        float_head head;
        sample_head(&head, 7);
        if (weight_info_read(&info, file.bytes, file.count, error, sizeof error) != 0) {
            fail_msg("%s", error);
        }
        assert_int_equal(t3r_weights_check(file.bytes, file.count), T3R_OK);
        assert_memory_equal(&info.graph, &head.graph, sizeof info.graph);
        assert_int_equal(info.weight_bits, variants[v][0]);
        assert_int_equal(info.activation_bits, variants[v][1]);
        assert_int_equal(info.bits_epoch, T3R_BITS_EPOCH);
        /* by hand: 6 x 36 x 9 / 4, 6 x 9 / 4, 5 x 16 x 6 / 16, 7 x 9 x 11 / 4, 16 x 10, 10 x 9 */
        assert_int_equal(info.macs_q8, 486 * 256 + 27 * 128 + 30 * 256 + 693 * 64 + 160 * 256 + 90 * 256);
        assert_int_equal(info.parameters, 6 * 324 + 6 + 54 + 6 + 480 + 5 + 693 + 7 + 4 * (160 + 10) + 90 + 9);
        weight_info_of_graph(&outline, &head.graph, variants[v][0], variants[v][1]);
        assert_int_equal(outline.bytes, file.count);
        assert_int_equal(outline.macs_q8, info.macs_q8);
        assert_int_equal(file.count % T3R_WEIGHTS_ALIGN, 0);
        float_head_free(&head);
        free(file.bytes);
    }
}

TEST(test_damage)
{
    sample_file file = make(8, 8);
    for (size_t cut = 0; cut < file.count; cut++) {
        sample_file part = copy_of(file.bytes, cut);
        refuse(&part, cut < T3R_WEIGHTS_HEADER_BYTES ? "not a weight file" : "not as long as it says");
        free(part.bytes);
    }
    for (size_t at = 16; at < file.count; at++) {
        file.bytes[at] ^= (uint8_t)(1u << at % 8);
        refuse(&file, "damaged");
        file.bytes[at] ^= (uint8_t)(1u << at % 8);
    }
    free(file.bytes);
}

TEST(test_header)
{
    refuse_header(WEIGHT_AT_MAGIC, 4, 0, "not a weight file");
    refuse_header(WEIGHT_AT_FORMAT, 2, 2, "another format");
    refuse_header(WEIGHT_AT_EPOCH, 2, T3R_BITS_EPOCH + 1, "made for bits epoch");
    refuse_header(WEIGHT_AT_WEIGHT_BITS, 1, 4, "8 or 16 bits");
    refuse_header(WEIGHT_AT_ACTIVATION_BITS, 1, 32, "8 or 16 bits");
    refuse_header(WEIGHT_AT_LAYERS, 1, 0, "layers must be 1..24");
    refuse_header(WEIGHT_AT_LAYERS, 1, 25, "layers must be 1..24");
    refuse_header(WEIGHT_AT_LAYERS, 1, 5, "layer 5: the last one is not");
    refuse_header(WEIGHT_AT_FEATURE_SET, 1, 2, "other features");
    refuse_header(WEIGHT_AT_MACS, 4, 1, "counts are not those of the layers");
    refuse_header(WEIGHT_AT_PARAMETERS, 4, 1, "counts are not those of the layers");
    refuse_header(WEIGHT_AT_RESERVED, 4, 1u << 24, "reserved bytes");
    refuse_header(WEIGHT_AT_NAME, 1, 0, "the header's name");
    refuse_header(WEIGHT_AT_NAME + 1, 1, 'A', "the header's name");
    refuse_header(WEIGHT_AT_NAME + 8, 8, UINT64_C(0x0061616161616161), "the header's name");
    refuse_header(WEIGHT_AT_RESERVED_END + 15, 1, 1, "reserved bytes");
    sample_file file = make(8, 8);
    t3r_store_le32(file.bytes + WEIGHT_AT_BYTES, 64);
    refuse(&file, "not as long as it says");
    memset(file.bytes + WEIGHT_AT_NAME, 'a', HEAD_NAME_BYTES);
    seal(&file);
    refuse(&file, "the header's name");
    memset(file.bytes + WEIGHT_AT_NAME, 0, HEAD_NAME_BYTES);
    seal(&file);
    refuse(&file, "the header's name");
    free(file.bytes);
    /* a table larger than the file */
    file = make(8, 8);
    sample_file part = copy_of(file.bytes, T3R_WEIGHTS_HEADER_BYTES + 5 * T3R_WEIGHTS_LAYER_BYTES);
    seal(&part);
    refuse(&part, "their table in the file");
    free(part.bytes);
    free(file.bytes);
}

TEST(test_layers)
{
    refuse_layer(1, LAYER_AT_KIND, 1, 3, "unknown kind");
    refuse_layer(1, LAYER_AT_LEVEL, 1, 5, "level not in");
    refuse_layer(1, LAYER_AT_LEVEL, 1, 0, "stride 2 does not lead");
    refuse_layer(1, LAYER_AT_SOURCE, 1, 1, "a source does not come before it");
    refuse_layer(1, LAYER_AT_SOURCE, 1, 255, "has no source");
    refuse_layer(1, LAYER_AT_SOURCE + 1, 1, 254, "a source does not come before it");
    refuse_layer(4, LAYER_AT_SOURCE + 1, 1, 255, "inputs are not its sources' channels");
    refuse_layer(6, LAYER_AT_SOURCE, 1, 2, "inputs are not");
    refuse_layer(4, LAYER_AT_SOURCE + 1, 1, 4, "a source does not come before it");
    refuse_layer(1, LAYER_AT_INPUTS, 2, 0, "inputs not in");
    refuse_layer(1, LAYER_AT_INPUTS, 2, 129, "inputs not in");
    refuse_layer(1, LAYER_AT_OUTPUTS, 2, 0, "outputs not in");
    refuse_layer(1, LAYER_AT_OUTPUTS, 2, 129, "outputs not in");
    refuse_layer(2, LAYER_AT_OUTPUTS, 2, 7, "outputs of a depthwise");
    refuse_layer(1, LAYER_AT_KERNEL, 1, 7, "kernel not in");
    refuse_layer(1, LAYER_AT_KERNEL, 1, 0, "kernel not in");
    refuse_layer(2, LAYER_AT_KERNEL, 1, 6, "kernel not in");
    refuse_layer(5, LAYER_AT_KERNEL, 1, 2, "level, kernel and stride of a point");
    refuse_layer(1, LAYER_AT_STRIDE, 1, 0, "stride neither");
    refuse_layer(1, LAYER_AT_STRIDE, 1, 3, "stride neither");
    refuse_layer(1, LAYER_AT_STRIDE, 1, 1, "a source is finer");
    refuse_layer(1, LAYER_AT_PHASES, 1, 4, "phases of other");
    refuse_layer(5, LAYER_AT_PHASES, 1, 3, "phases are neither");
    refuse_row(1, LAYER_AT_RESERVED, 1, 1, "reserved bytes");
    refuse_row(1, LAYER_AT_RESERVED_2, 2, 256, "reserved bytes");
    refuse_row(1, LAYER_AT_ZERO, 2, 128, "an output zero is no int8");
    refuse_row(1, LAYER_AT_ZERO, 2, 0xff7f, "an output zero is no int8");
    refuse_layer(6, LAYER_AT_ZERO, 2, 0xff80, "the last one is not a linear");
    refuse_row(6, LAYER_AT_ZERO, 2, 1, "the last layer is not a linear");
    for (uint32_t n = 1; n <= 6; n++) {
        refuse_row(n, LAYER_AT_WEIGHTS, 4, 72, "not aligned to 16");
        refuse_row(n, LAYER_AT_BIAS, 4, 1000 * 16 + 8, "not aligned to 16");
        refuse_row(n, LAYER_AT_MULTIPLIER, 4, 1, "not aligned to 16");
        refuse_row(n, LAYER_AT_SHIFT, 4, 0xffffffff, "not aligned to 16");
        refuse_row(n, LAYER_AT_WEIGHTS, 4, 0xfffffff0, "outside the file");
        refuse_row(n, LAYER_AT_WEIGHTS, 4, 240, "outside the file"); /* in the table */
        refuse_row(n, LAYER_AT_BIAS, 4, 0, "outside the file");
        refuse_row(n, LAYER_AT_MULTIPLIER, 4, 1u << 20, "outside the file");
        refuse_row(n, LAYER_AT_SHIFT, 4, 0x80000000, "outside the file");
    }
}

/* Returns the offset of a block of layer 1. */
static size_t block_at(uint32_t weight_bits, uint32_t activation_bits, enum weight_block block)
{
    sample_file file = make(weight_bits, activation_bits);
    size_t at = t3r_load_le32(file.bytes + T3R_WEIGHTS_HEADER_BYTES + LAYER_AT_WEIGHTS + 4 * (size_t)block);
    free(file.bytes);
    return at;
}

TEST(test_numbers)
{
    refuse_header(block_at(8, 8, BLOCK_MULTIPLIER) + 20, 4, (1 << 30) - 1, "a multiplier or shift");
    refuse_header(block_at(8, 8, BLOCK_MULTIPLIER), 4, 1u << 31, "a multiplier or shift");
    refuse_header(block_at(8, 8, BLOCK_SHIFT) + 5, 1, 16, "a multiplier or shift");
    refuse_header(block_at(8, 8, BLOCK_SHIFT), 1, 256 - 31, "a multiplier or shift");
    refuse_header(block_at(8, 8, BLOCK_BIAS), 4, 0x7fffffff, "sums could leave");
    refuse_header(block_at(8, 8, BLOCK_BIAS) + 20, 4, 0x80000000, "sums could leave");
    refuse_change(16, 16, block_at(16, 16, BLOCK_BIAS), 8, UINT64_C(1) << 47, "sums could leave");
    refuse_change(8, 16, block_at(8, 16, BLOCK_BIAS), 8, UINT64_C(1) << 63, "sums could leave");
    /* weights alone: 324 of them at their maximum, times 2^7, exceed 2^30 */
    sample_file file = make(16, 8);
    size_t at = block_at(16, 8, BLOCK_WEIGHTS);
    for (size_t i = 0; i < 6 * 324; i++) {
        t3r_store_le16(file.bytes + at + 2 * i, 0x8000);
    }
    t3r_store_le32(file.bytes + block_at(16, 8, BLOCK_BIAS), 0x40000000);
    seal(&file);
    refuse(&file, "sums could leave");
    free(file.bytes);
}

/* Sets fields to many values, with a matching CRC: the rules for layers, written once for firmware and once for the
 * host, accept the same files. */
TEST(test_agreement)
{
    static const uint32_t variants[4][2] = {{8, 8}, {8, 16}, {16, 8}, {16, 16}};
    static const uint8_t values[] = {0, 1, 2, 3, 4, 5, 6, 7, 9, 10, 16, 64, 127, 128, 129, 254, 255};
    const size_t table = T3R_WEIGHTS_HEADER_BYTES + 6 * T3R_WEIGHTS_LAYER_BYTES;
    uint32_t taken = 0, refused = 0;
    for (int v = 0; v < 4; v++) {
        sample_file file = make(variants[v][0], variants[v][1]);
        for (size_t at = 0; at < table + 64; at++) {
            uint8_t before = file.bytes[at];
            for (size_t i = 0; i < sizeof values; i++) {
                file.bytes[at] = values[i];
                if (at >= WEIGHT_AT_SEALED) {
                    seal(&file);
                }
                weight_info info;
                char error[256] = "";
                int status = weight_info_read(&info, file.bytes, file.count, error, sizeof error);
                bool sound = t3r_weights_check(file.bytes, file.count) == T3R_OK;
                if ((status == 0) != sound) {
                    fail_msg("byte %zu as %u: '%s', the runtime %s it", at, values[i], error,
                             sound ? "takes" : "refuses");
                }
                taken += sound;
                refused += !sound;
            }
            file.bytes[at] = before;
            seal(&file);
        }
        free(file.bytes);
    }
    assert_true(taken > 1000);
    assert_true(refused > 10000);
}
