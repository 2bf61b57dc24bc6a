/* SPDX-License-Identifier: Apache-2.0 */
/* Float heads: tensors are stored at the right places, and every mistake in the description or a tensor is refused. */
#include "float_head.h"

#include <cjson/cJSON.h>

#include "sample_head.h"
#include "unit/unit.h"

static const char DESCRIPTION[] =
    "{\"format\":1,\"name\":\"tiny\",\"feature_set\":1,\"layers\":["
    "{\"kind\":\"conv\",\"level\":1,\"sources\":[0],\"inputs\":9,\"outputs\":2,\"kernel\":2,\"stride\":2,\"phases\":1,"
    "\"relu\":true},"
    "{\"kind\":\"depthwise\",\"level\":1,\"sources\":[1],\"inputs\":2,\"outputs\":2,\"kernel\":3,\"stride\":1,"
    "\"phases\":1,\"relu\":false},"
    "{\"kind\":\"point\",\"level\":0,\"sources\":[2,0],\"inputs\":11,\"outputs\":3,\"kernel\":1,\"stride\":1,"
    "\"phases\":4,\"relu\":true},"
    "{\"kind\":\"point\",\"sources\":[3],\"inputs\":3,\"outputs\":9,\"relu\":false}]}";

typedef struct tensor {
    const char *name, *shape;
    size_t elements;
} tensor;

#define TENSORS 9
static const tensor sound[TENSORS] = {
    {"layer1.weight", "[2,9,2,2]", 72}, {"layer1.bias", "[2]", 2},        {"layer2.weight", "[2,1,3,3]", 18},
    {"layer2.bias", "[2]", 2},          {"layer2.range", "[2]", 2},       {"layer3.weight", "[4,3,11]", 132},
    {"layer3.bias", "[4,3]", 12},       {"layer4.weight", "[1,9,3]", 27}, {"layer4.bias", "[1,9]", 9}};

/* Makes the file; tensor t holds 1000 t + i + 1 at place i, but `odd` at its place 1 if t is odd_at. */
static uint8_t *file_of(const char *description, const tensor tensors[TENSORS], size_t odd_at, float odd, size_t *count)
{
    cJSON *header = cJSON_CreateObject(), *metadata = cJSON_AddObjectToObject(header, "__metadata__");
    size_t at = 0;
    if (description != NULL) {
        cJSON_AddStringToObject(metadata, "trim3r", description);
    }
    for (size_t t = 0; t < TENSORS && tensors[t].name != NULL; t++) {
        char text[128];
        snprintf(text, sizeof text, "{\"dtype\":\"F32\",\"shape\":%s,\"data_offsets\":[%zu,%zu]}", tensors[t].shape, at,
                 at + 4 * tensors[t].elements);
        cJSON_AddRawToObject(header, tensors[t].name, text);
        at += 4 * tensors[t].elements;
    }
    char *text = cJSON_PrintUnformatted(header);
    size_t length = strlen(text);
    *count = 8 + length + at;
    uint8_t *file = unit_array(*count, 1), *data = file + 8 + length;
    for (int i = 0; i < 8; i++) {
        file[i] = (uint8_t)((uint64_t)length >> (8 * i));
    }
    memcpy(file + 8, text, length);
    for (size_t t = 0; t < TENSORS && tensors[t].name != NULL; t++) {
        for (size_t i = 0; i < tensors[t].elements; i++, data += 4) {
            float value = t == odd_at && i == 1 ? odd : (float)(1000 * t + i + 1);
            uint32_t bits;
            memcpy(&bits, &value, sizeof bits);
            for (int b = 0; b < 4; b++) {
                data[b] = (uint8_t)(bits >> (8 * b));
            }
        }
    }
    cJSON_free(text);
    cJSON_Delete(header);
    return file;
}

static void refuse(const char *description, const tensor tensors[TENSORS], size_t odd_at, float odd, const char *why)
{
    size_t count;
    float_head head;
    char error[256] = "";
    uint8_t *file = file_of(description, tensors, odd_at, odd, &count);
    int status = float_head_parse(&head, file, count, error, sizeof error);
    free(file);
    if (status != -1 || strstr(error, why) == NULL) {
        fail_msg("%d: '%s' does not say '%s'", status, error, why);
    }
    assert_null(head.layers[0].weight);
}

/* Refuses the description with the n-th `from` (counted from 1) replaced by `to`. */
static void refuse_change(int n, const char *from, const char *to, const char *why)
{
    char text[sizeof DESCRIPTION + 4096];
    const char *at = DESCRIPTION - 1;
    for (int i = 0; i < n; i++) {
        at = strstr(at + 1, from);
        assert_non_null(at);
    }
    snprintf(text, sizeof text, "%.*s%s%s", (int)(at - DESCRIPTION), DESCRIPTION, to, at + strlen(from));
    refuse(text, sound, TENSORS, 0, why);
}

TEST(test_reads)
{
    size_t count;
    float_head head;
    char error[256] = "";
    uint8_t *file = file_of(DESCRIPTION, sound, TENSORS, 0, &count);
    if (float_head_parse(&head, file, count, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    free(file);
    assert_string_equal(head.graph.name, "tiny");
    assert_int_equal(head.graph.count, 4);
    /* torch's [out][in][ky][kx] as [out][ky][kx][in], [channel][1][ky][kx] as [ky][kx][channel] */
    for (uint32_t o = 0; o < 2; o++) {
        for (uint32_t t = 0; t < 4; t++) {
            for (uint32_t i = 0; i < 9; i++) {
                assert_true(head.layers[0].weight[(o * 4 + t) * 9 + i] == (float)((o * 9 + i) * 4 + t + 1));
            }
        }
        for (uint32_t t = 0; t < 9; t++) {
            assert_true(head.layers[1].weight[t * 2 + o] == (float)(2000 + o * 9 + t + 1));
        }
    }
    for (uint32_t i = 0; i < 132; i++) {
        assert_true(head.layers[2].weight[i] == (float)(5000 + i + 1));
    }
    assert_true(head.layers[2].bias[11] == 6012);
    assert_null(head.layers[0].range);
    assert_true(head.layers[1].range[1] == 4002);
    float_head_free(&head);
}

/* A written head reads back unchanged. */
TEST(test_round_trip)
{
    size_t count;
    float_head head, back;
    char error[256] = "";
    sample_head(&head, 9);
    uint8_t *file = sample_safetensors(&head, &count);
    if (float_head_parse(&back, file, count, error, sizeof error) != 0) {
        fail_msg("%s", error);
    }
    free(file);
    assert_memory_equal(&back.graph, &head.graph, sizeof back.graph);
    for (uint32_t i = 0; i < head.graph.count; i++) {
        const head_layer *layer = &head.graph.layers[i];
        assert_memory_equal(back.layers[i].weight, head.layers[i].weight, head_weight_count(layer) * sizeof(float));
        assert_memory_equal(back.layers[i].bias, head.layers[i].bias, head_bias_count(layer) * sizeof(float));
        if (i + 1 < head.graph.count) {
            assert_memory_equal(back.layers[i].range, head.layers[i].range, layer->outputs * sizeof(float));
        } else {
            assert_null(back.layers[i].range);
        }
    }
    float_head_free(&back);
    float_head_free(&head);
}

TEST(test_description)
{
    refuse(NULL, sound, TENSORS, 0, "__metadata__ has no \"trim3r\"");
    refuse("nonsense", sound, TENSORS, 0, "trim3r: not one JSON object");
    refuse("[]", sound, TENSORS, 0, "trim3r: not one JSON object");
    refuse("{} {}", sound, TENSORS, 0, "trim3r: not one JSON object");
    refuse_change(1, "\"format\":1", "\"format\":1,\"format\":1", "trim3r: 'format' stands there twice");
    refuse_change(1, "\"kind\":", "\"kind\":\"conv\",\"kind\":", "layers: 'kind' stands there twice");
    refuse_change(1, "\"tiny\"", "\"tiny\\u0000\"", "\\u0000 in a string");
    refuse_change(1, "\"format\":1", "\"format\":2", "trim3r: format: not 1");
    refuse_change(1, "\"format\":1", "\"format\":\"1\"", "trim3r: format: not a whole number");
    refuse_change(1, "\"format\":1,", "", "trim3r: format: missing");
    refuse_change(1, "\"feature_set\":1", "\"feature_set\":2", "trim3r: feature_set: not 1");
    refuse_change(1, "\"tiny\"", "5", "trim3r: name: not a string");
    refuse_change(1, "\"tiny\"", "\"\"", "the name '' is not 1 to 15");
    refuse_change(1, "\"tiny\"", "\"sixteen_letters_\"", "is not 1 to 15");
    refuse_change(1, "\"tiny\"", "\"a-b\"", "the name 'a-b'");
    refuse_change(1, "\"name\"", "\"nam\"", "trim3r: nam: unknown");
    refuse_change(1, "\"layers\":[", "\"layers\":5,\"x\":[", "trim3r: x: unknown");
    refuse("{\"format\":1,\"name\":\"a\",\"feature_set\":1}", sound, TENSORS, 0, "trim3r: layers: missing");
    refuse("{\"format\":1,\"name\":\"a\",\"feature_set\":1,\"layers\":[]}", sound, TENSORS, 0, "0 layers, not 1..24");
    refuse("{\"format\":1,\"name\":\"a\",\"feature_set\":1,\"layers\":[1]}", sound, TENSORS, 0, "layer 1: it: not an");
}

TEST(test_layers)
{
    refuse_change(1, "\"kind\":\"conv\"", "\"kind\":\"dense\"", "layer 1: kind: not one of");
    refuse_change(1, "\"kind\":\"conv\",", "", "layer 1: kind: missing");
    refuse_change(1, "\"level\":1,", "", "layer 1: level: missing");
    refuse_change(1, "\"level\":1", "\"level\":-1", "layer 1: level: not a whole number");
    refuse_change(1, "\"level\":1", "\"level\":0", "layer 1: stride 2 does not lead to level 0");
    refuse_change(1, "\"level\":1", "\"level\":2", "layer 1: a source is finer than its stride allows");
    refuse_change(1, "\"level\":1", "\"level\":5", "layer 1: level not in 0..4");
    refuse_change(1, "\"sources\":[0]", "\"sources\":[]", "layer 1: sources: empty");
    refuse_change(1, "\"sources\":[0]", "\"sources\":[1]", "layer 1: sources: not 0 (features)");
    refuse_change(1, "\"sources\":[0]", "\"sources\":[0,0,0]", "layer 1: sources: more than two");
    refuse_change(1, "\"sources\":[0]", "\"sources\":[0,0]", "layer 1: inputs are not its sources' channels");
    refuse_change(1, "\"sources\":[0]", "\"sources\":0", "layer 1: sources: not an array");
    refuse_change(1, "\"sources\":[1]", "\"sources\":[1,0]", "layer 2: a depthwise layer has one source");
    refuse_change(1, "\"sources\":[2,0]", "\"sources\":[1,0]", "layer 2: no later layer reads it");
    refuse_change(1, "\"sources\":[3]", "\"sources\":[2]", "layer 4: inputs are not");
    refuse_change(1, "\"inputs\":9", "\"inputs\":8", "layer 1: inputs are not");
    refuse_change(1, "\"inputs\":9", "\"inputs\":0", "layer 1: inputs not in 1..128");
    refuse_change(1, "\"outputs\":2", "\"outputs\":129", "layer 1: outputs not in 1..128");
    refuse_change(1, "\"outputs\":2", "\"outputs\":3", "layer 2: inputs are not");
    refuse_change(2, "\"outputs\":2", "\"outputs\":3", "layer 2: outputs of a depthwise layer are its inputs");
    refuse_change(1, "\"outputs\":9", "\"outputs\":8", "layer 4: the last one is not");
    refuse_change(1, "\"kernel\":2", "\"kernel\":7", "layer 1: kernel not in 1..6");
    refuse_change(1, "\"kernel\":2,", "", "layer 1: kernel: missing");
    refuse_change(1, "\"kernel\":3", "\"kernel\":6", "layer 2: kernel not in 1..6 (depthwise: 1..5)");
    refuse_change(1, "\"kernel\":3", "\"kernel\":0", "layer 2: kernel not in");
    refuse_change(1, "\"kernel\":1", "\"kernel\":3", "layer 3: level, kernel and stride of a point layer");
    refuse_change(1, "\"stride\":2", "\"stride\":3", "layer 1: stride neither 1 nor 2");
    refuse_change(1, "\"stride\":2", "\"stride\":1", "layer 1: a source is finer");
    refuse_change(1, "\"phases\":1", "\"phases\":4", "layer 1: phases of other than point layers are 1");
    refuse_change(1, "\"phases\":4", "\"phases\":2", "layer 3: phases are neither 1 nor 4");
    refuse_change(1, "\"relu\":true", "\"relu\":1", "layer 1: relu: not true or false");
    refuse_change(1, "\"relu\":true", "\"bias\":true", "layer 1: bias: unknown");
    refuse_change(2, "\"relu\":false", "\"relu\":true", "layer 4: the last one is not");
}

TEST(test_tensors)
{
    tensor changed[TENSORS];
    static const struct {
        size_t at;
        tensor to;
        const char *why;
    } cases[] = {
        {0, {"layer1.weights", "[2,9,2,2]", 72}, "layer 1: weight: the tensor is missing"},
        {1, {"layer1.biases", "[2]", 2}, "layer 1: bias: the tensor is missing"},
        {4, {"layer2.ranges", "[2]", 2}, "1 tensors belong to no layer"},
        {4, {"layer5.range", "[2]", 2}, "1 tensors belong to no layer"},
        {0, {"layer1.weight", "[2,2,9,2]", 72}, "layer 1: weight: the tensor's shape"},
        {0, {"layer1.weight", "[72]", 72}, "layer 1: weight: the tensor's shape"},
        {2, {"layer2.weight", "[1,2,3,3]", 18}, "layer 2: weight: the tensor's shape"},
        {3, {"layer2.bias", "[2,1]", 2}, "layer 2: bias: the tensor's shape"},
        {4, {"layer2.range", "[3]", 3}, "layer 2: range: the tensor's shape"},
        {6, {"layer3.bias", "[3,4]", 12}, "layer 3: bias: the tensor's shape"},
        {7, {"layer4.weight", "[9,3]", 27}, "layer 4: weight: the tensor's shape"},
    };
    for (size_t i = 0; i < sizeof cases / sizeof *cases; i++) {
        memcpy(changed, sound, sizeof changed);
        changed[cases[i].at] = cases[i].to;
        refuse(DESCRIPTION, changed, TENSORS, 0, cases[i].why);
    }
    memcpy(changed, sound, sizeof changed);
    changed[TENSORS - 1].name = NULL;
    refuse(DESCRIPTION, changed, TENSORS, 0, "layer 4: bias: the tensor is missing");
    refuse(DESCRIPTION, sound, 0, NAN, "layer 1: weight: holds a number that is not finite");
    refuse(DESCRIPTION, sound, 6, INFINITY, "layer 3: bias: holds a number that is not finite");
    refuse(DESCRIPTION, sound, 4, 0, "layer 2: range: holds a number that is not positive");
    refuse(DESCRIPTION, sound, 4, -1, "layer 2: range: holds a number that is not positive");
}
