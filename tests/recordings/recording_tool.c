/* SPDX-License-Identifier: Apache-2.0 */
/* For the tests' scripts: `recording_tool sample STORAGE FORMAT FILE` writes the sample recording (sample.h),
 * `recording_tool dump FILE` prints a recording's contents as JSON, `recording_tool seeds FOLDER` writes a fuzzer's
 * seeds. Fixed-point numbers that may not fit a double are strings. */
#include <cjson/cJSON.h>
#include <inttypes.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "messages/pixel_layout.h"
#include "sample.h"
#include "seeds.h"

static int write_sample(const char *stored, const char *encoding, const char *path)
{
    t3r_pixel_format format;
    if (!t3r_pixel_format_of(t3r_text_of(encoding), &format)) {
        fprintf(stderr, "recording_tool: no format %s\n", encoding);
        return 2;
    }
    uint32_t storage = 0;
    while (storage < SAMPLE_STORAGES && strcmp(sample_storages[storage], stored) != 0) {
        storage++;
    }
    FILE *file = storage < SAMPLE_STORAGES ? fopen(path, "w+b") : NULL;
    if (file == NULL) {
        perror(path);
        return 1;
    }
    int failed = sample_write(t3r_file_sink(file), format, storage);
    failed |= fclose(file);
    return failed != 0;
}

static void add_int64(cJSON *object, const char *name, int64_t value)
{
    char text[24];
    snprintf(text, sizeof text, "%" PRId64, value);
    cJSON_AddStringToObject(object, name, text);
}

/* Adds rows without padding, as hexadecimal digits. */
static void add_rows(cJSON *object, const char *name, const uint8_t *rows, uint32_t stride, uint32_t row_bytes,
                     uint32_t count)
{
    char *text = malloc((size_t)row_bytes * count * 2 + 1), *at = text;
    *at = '\0';
    for (uint32_t y = 0; y < count; y++) {
        for (uint32_t i = 0; i < row_bytes; i++, at += 2) {
            snprintf(at, 3, "%02x", rows[(size_t)y * stride + i]);
        }
    }
    cJSON_AddStringToObject(object, name, text);
    free(text);
}

static cJSON *int32s(const int32_t *values, int count)
{
    return cJSON_CreateIntArray(values, count);
}

static cJSON *describe(const t3r_capture_frame *frame)
{
    cJSON *json = cJSON_CreateObject();
    const t3r_frame *image = &frame->frame;
    cJSON_AddNumberToObject(json, "index", frame->index);
    add_int64(json, "stamp_ns", frame->stamp_ns);
    cJSON_AddStringToObject(json, "encoding", t3r_pixel_encoding(image->format));
    cJSON_AddNumberToObject(json, "width", image->width);
    cJSON_AddNumberToObject(json, "height", image->height);
    for (uint32_t p = 0; p < 2; p++) {
        add_rows(json, p == 0 ? "plane0" : "plane1", image->planes[p], image->stride_bytes[p],
                 t3r_pixel_row_bytes(image->format, image->width), t3r_pixel_rows(image->format, p, image->height));
    }
    if (image->depth != NULL) {
        cJSON_AddNumberToObject(json, "depth_width", image->depth_width);
        cJSON_AddNumberToObject(json, "depth_height", image->depth_height);
        add_int64(json, "depth_unit_q40", (int64_t)image->depth_unit_q40);
        add_rows(json, "depth", image->depth, image->depth_stride_bytes, image->depth_width * 2, image->depth_height);
    }
    if (frame->has_intrinsics) {
        const int32_t k[4] = {frame->camera.fx_q16, frame->camera.fy_q16, frame->camera.cx_q16, frame->camera.cy_q16};
        cJSON_AddItemToObject(json, "fx_fy_cx_cy_q16", int32s(k, 4));
        cJSON_AddNumberToObject(json, "distortion", frame->camera.distortion);
        cJSON_AddItemToObject(json, "distortion_q24", int32s(frame->camera.distortion_q24, 5));
    }
    if (frame->has_pose) {
        cJSON *position = cJSON_AddArrayToObject(json, "position_q32");
        for (uint32_t i = 0; i < 3; i++) {
            char text[24];
            snprintf(text, sizeof text, "%" PRId64, frame->camera.position_q32[i]);
            cJSON_AddItemToArray(position, cJSON_CreateString(text));
        }
        cJSON_AddItemToObject(json, "rotation_q30", int32s(frame->camera.rotation_q30, 4));
    }
    return json;
}

static int dump(const char *path)
{
    char error[256] = "";
    t3r_recording *recording = t3r_recording_open(path, error, sizeof error);
    if (recording == NULL) {
        fprintf(stderr, "recording_tool: %s\n", error);
        return 1;
    }
    cJSON *json = cJSON_CreateObject();
    cJSON_AddStringToObject(json, "note", t3r_recording_note(recording));
    cJSON_AddStringToObject(json, "clock", t3r_recording_clock(recording));
    cJSON_AddNumberToObject(json, "bits_epoch", t3r_recording_bits_epoch(recording));
    cJSON *streams = cJSON_AddArrayToObject(json, "streams");
    for (uint32_t i = 0; i < t3r_recording_stream_count(recording); i++) {
        t3r_stream_info info = t3r_recording_stream(recording, i);
        cJSON *stream = cJSON_CreateObject();
        cJSON_AddStringToObject(stream, "topic", info.topic);
        cJSON_AddStringToObject(stream, "schema", info.schema);
        cJSON_AddNumberToObject(stream, "messages", (double)info.messages);
        cJSON_AddItemToArray(streams, stream);
    }
    cJSON *triplets = cJSON_AddArrayToObject(json, "triplets");
    for (uint32_t i = 0; i < t3r_recording_triplet_count(recording); i++) {
        t3r_triplet t = t3r_recording_triplet(recording, i);
        const int32_t members[3] = {(int32_t)t.context[0], (int32_t)t.context[1], (int32_t)t.target};
        cJSON_AddItemToArray(triplets, int32s(members, 3));
    }
    cJSON *frames = cJSON_AddArrayToObject(json, "frames");
    int status = 0;
    for (uint32_t i = 0; i < t3r_recording_frame_count(recording) && status == 0; i++) {
        t3r_capture_frame frame;
        if (t3r_recording_frame(recording, i, &frame, error, sizeof error) != T3R_CAPTURE_FRAME) {
            fprintf(stderr, "recording_tool: %s: %s\n", path, error);
            status = 1;
        } else {
            cJSON_AddItemToArray(frames, describe(&frame));
        }
    }
    char *text = cJSON_PrintUnformatted(json);
    if (status == 0) {
        puts(text);
    }
    cJSON_free(text);
    cJSON_Delete(json);
    t3r_recording_close(recording);
    return status;
}

int main(int argc, char **argv)
{
    if (argc == 5 && strcmp(argv[1], "sample") == 0) {
        return write_sample(argv[2], argv[3], argv[4]);
    }
    if (argc == 3 && strcmp(argv[1], "dump") == 0) {
        return dump(argv[2]);
    }
    if (argc == 3 && strcmp(argv[1], "seeds") == 0) {
        return seeds_write(argv[2]) != 0;
    }
    fputs("usage: recording_tool sample STORAGE FORMAT FILE | dump FILE | seeds FOLDER\n", stderr);
    return 2;
}
