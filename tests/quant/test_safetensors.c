/* SPDX-License-Identifier: Apache-2.0 */
/* .safetensors: valid files are read, and all others are refused with a reason. */
#include "safetensors.h"

#include "unit/unit.h"

#define TENSOR(name, shape, begin, end)                                                                                \
    "\"" name "\":{\"dtype\":\"F32\",\"shape\":" shape ",\"data_offsets\":[" begin "," end "]}"

/* Makes a header and `data_bytes` bytes of data, in memory of exactly their size. */
static uint8_t *file_of(const char *header, size_t data_bytes, size_t *count)
{
    size_t length = strlen(header);
    *count = 8 + length + data_bytes;
    uint8_t *file = unit_array(*count, 1);
    for (int i = 0; i < 8; i++) {
        file[i] = (uint8_t)((uint64_t)length >> (8 * i));
    }
    memcpy(file + 8, header, length);
    for (size_t i = 0; i < data_bytes; i++) {
        file[8 + length + i] = (uint8_t)(i % 4 == 3 ? 0x40 : i / 4);
    }
    return file;
}

static void refuse_bytes(const uint8_t *file, size_t count, const char *why)
{
    safetensors out;
    char error[256] = "";
    assert_int_equal(safetensors_parse(&out, file, count, error, sizeof error), -1);
    if (strstr(error, why) == NULL) {
        fail_msg("'%s' does not say '%s'", error, why);
    }
    assert_null(out.tensors);
    assert_null(out.header);
}

static void refuse(const char *header, size_t data_bytes, const char *why)
{
    size_t count;
    uint8_t *file = file_of(header, data_bytes, &count);
    refuse_bytes(file, count, why);
    free(file);
}

TEST(test_reads)
{
    size_t count;
    uint8_t *file = file_of("{\"__metadata__\":{\"trim3r\":\"a text\"}," TENSOR("b", "[2,1]", "4", "12") "," TENSOR(
                                "a", "[]", "0", "4") "," TENSOR("none", "[3,0]", "4", "4") "}   ",
                            12, &count);
    safetensors out;
    char error[256] = "";
    assert_int_equal(safetensors_parse(&out, file, count, error, sizeof error), 0);
    assert_int_equal(out.count, 3);
    assert_string_equal(safetensors_metadata(&out, "trim3r"), "a text");
    assert_null(safetensors_metadata(&out, "other"));
    const safetensors_tensor *b = safetensors_find(&out, "b"), *a = safetensors_find(&out, "a");
    assert_non_null(a);
    assert_non_null(b);
    assert_null(safetensors_find(&out, "c"));
    assert_int_equal(a->elements, 1);
    assert_int_equal(a->rank, 0);
    assert_int_equal(b->rank, 2);
    assert_int_equal(b->shape[0], 2);
    /* bytes 1 1 1 0x40 and 2 2 2 0x40 */
    const uint32_t bits[2] = {0x40010101, 0x40020202};
    for (uint64_t i = 0; i < 2; i++) {
        float expected, got = safetensors_element(b, i);
        memcpy(&expected, &bits[i], sizeof expected);
        assert_memory_equal(&expected, &got, sizeof got);
    }
    safetensors_free(&out);
    free(file);
}

TEST(test_frame)
{
    size_t count;
    uint8_t *file = file_of("{" TENSOR("a", "[1]", "0", "4") "}", 4, &count);
    for (size_t cut = 0; cut < count; cut++) {
        uint8_t *part = unit_array(cut == 0 ? 1 : cut, 1);
        memcpy(part, file, cut);
        refuse_bytes(part, cut, cut < 8 ? "takes 8" : cut < count - 4 ? "cut off" : "outside the file");
        free(part);
    }
    memset(file, 0xff, 8);
    refuse_bytes(file, count, "not a .safetensors");
    free(file);
    refuse("", 0, "not one JSON object");
    refuse("[]", 0, "not one JSON object");
    refuse("{} x", 0, "not one JSON object");
    refuse("{\"a\":", 0, "not one JSON object");
    refuse("{}", 3, "3 bytes after the last tensor");
}

TEST(test_tensors)
{
    refuse("{\"a\":5}", 0, "tensor 'a': not an object");
    refuse("{\"a\":{\"shape\":[1],\"data_offsets\":[0,4]}}", 4, "dtype is not F32");
    refuse("{\"a\":{\"dtype\":\"F16\",\"shape\":[2],\"data_offsets\":[0,4]}}", 4, "dtype is not F32");
    refuse("{\"a\":{\"dtype\":\"F32\",\"data_offsets\":[0,4]}}", 4, "shape is not an array");
    refuse("{" TENSOR("a", "[1,1,1,1,1,1,1,1,1]", "0", "4") "}", 4, "more than 8 dimensions");
    refuse("{" TENSOR("a", "[-1]", "0", "4") "}", 4, "something else than whole numbers");
    refuse("{" TENSOR("a", "[0.5]", "0", "2") "}", 2, "something else than whole numbers");
    refuse("{" TENSOR("a", "[\"1\"]", "0", "4") "}", 4, "something else than whole numbers");
    refuse("{" TENSOR("a", "[65536,65536,65536,65536]", "0", "0") "}", 0, "more than 2^32");
    refuse("{" TENSOR("a", "[1e300]", "0", "4") "}", 4, "something else than whole numbers");
    refuse("{\"a\":{\"dtype\":\"F32\",\"shape\":[1]}}", 4, "not two whole numbers");
    refuse("{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0]}}", 4, "not two whole numbers");
    refuse("{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"data_offsets\":[0,4,8]}}", 4, "not two whole numbers");
    refuse("{" TENSOR("a", "[1]", "4", "0") "}", 4, "outside the file");
    refuse("{" TENSOR("a", "[2]", "0", "8") "}", 4, "outside the file");
    refuse("{" TENSOR("a", "[1]", "-4", "0") "}", 4, "not two whole numbers");
    refuse("{" TENSOR("a", "[2]", "0", "4") "}", 4, "do not agree");
    refuse("{" TENSOR("a", "[2]", "0", "8") "," TENSOR("b", "[1]", "4", "8") "}", 8, "tensor 'b': overlaps");
    refuse("{" TENSOR("a", "[1]", "0", "4") "," TENSOR("b", "[1]", "8", "12") "}", 12, "tensor 'b': a gap");
    refuse("{" TENSOR("a", "[1]", "4", "8") "}", 8, "tensor 'a': a gap");
    refuse("{" TENSOR("a", "[1]", "0", "4") "," TENSOR("a", "[1]", "4", "8") "}", 8, "'a' stands there twice");
    refuse("{\"a\":{\"dtype\":\"F32\",\"shape\":[1],\"shape\":[1],\"data_offsets\":[0,4]}}", 4,
           "a: 'shape' stands there twice");
    refuse("{" TENSOR("a\\u0000b", "[1]", "0", "4") "}", 4, "header: \\u0000 in a string");
    refuse("{" TENSOR("\\u0007\\u00fc", "[2]", "0", "4") "}", 4, "tensor '?\?\?'");
}

TEST(test_metadata)
{
    refuse("{\"__metadata__\":\"text\"}", 0, "__metadata__: not an object");
    refuse("{\"__metadata__\":{\"a\":1}}", 0, "'a' is not a string");
    refuse("{\"__metadata__\":{\"a\":\"x\",\"a\":\"y\"}}", 0, "'a' stands there twice");
    refuse("{\"__metadata__\":{},\"__metadata__\":{}}", 0, "'__metadata__' stands there twice");
}
