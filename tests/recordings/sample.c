/* SPDX-License-Identifier: Apache-2.0 */
#include "sample.h"

#include <string.h>

#include "mcap/chunk_packer.h"
#include "messages/pixel_layout.h"

#define PADDING 5u /* bytes after each row in memory, not to be recorded */

uint8_t sample_byte(uint32_t frame, uint32_t plane, uint32_t i)
{
    return (uint8_t)(7 * frame + 31 * plane + 13 * i);
}

uint16_t sample_depth(uint32_t frame, uint32_t i)
{
    return (uint16_t)(i == 1 ? 0 : 1000 + 257 * i + 16 * frame);
}

int64_t sample_stamp(uint32_t frame)
{
    return INT64_C(5000000000) + INT64_C(33333333) * frame;
}

t3r_recorded_camera sample_camera(uint32_t frame)
{
    static const double coefficients[SAMPLE_FRAMES][5] = {
        {0}, {0.1, -0.2, 0.001, 0.002, 0.05}, {0.01, 0.02, -0.03, 0.04}};
    static const t3r_distortion distortions[SAMPLE_FRAMES] = {T3R_DISTORTION_NONE, T3R_DISTORTION_RADTAN,
                                                              T3R_DISTORTION_FISHEYE};
    double f = frame;
    t3r_recorded_camera camera = {
        .width = SAMPLE_WIDTH,
        .height = SAMPLE_HEIGHT,
        .fx = 100.25 + f,
        .fy = 101.5,
        .cx = 2.5,
        .cy = 1.5 - f,
        .distortion = distortions[frame],
        .position = {f / 3, -2.5, 1e-3 * f},
        .rotation = {0.5, 0.5, -0.5, 0.5},
    };
    if (frame == 1) {
        memcpy(camera.rotation, (double[]){1, 0, 0, 0}, sizeof camera.rotation);
    }
    memcpy(camera.coefficients, coefficients[frame], sizeof camera.coefficients);
    return camera;
}

t3r_triplet sample_triplet(uint32_t index)
{
    return index == 0 ? (t3r_triplet){{0, 2}, 1} : (t3r_triplet){{1, 0}, 2};
}

const char *const sample_storages[SAMPLE_STORAGES] = {"none", "zstd", "lz4", "unchunked"};

int sample_write(t3r_sink sink, t3r_pixel_format format, uint32_t storage)
{
    const t3r_chunk_packer *packer =
        t3r_chunk_packer_open(storage == SAMPLE_UNCHUNKED ? T3R_COMPRESSION_NONE : (t3r_compression)storage);
    uint64_t state[T3R_RECORDER_BYTES / 8];
    t3r_recorder *recorder = (t3r_recorder *)state;
    const t3r_triplet triplets[] = {sample_triplet(0), sample_triplet(1)};
    const t3r_recording_header header = {
        .camera = "camera",
        .source = "sample",
        .clock = "synthetic",
        .depth_unit = 0.0002,
        .triplets = triplets,
        .triplet_count = 2,
        .unchunked = storage == SAMPLE_UNCHUNKED,
        .packer = packer,
    };
    int failed = t3r_recorder_begin(recorder, sink, &header);
    for (uint32_t f = 0; f < SAMPLE_FRAMES; f++) {
        uint8_t planes[2][(SAMPLE_WIDTH * 3 + PADDING) * SAMPLE_HEIGHT];
        uint16_t depth[SAMPLE_DEPTH_WIDTH * SAMPLE_DEPTH_HEIGHT];
        uint32_t row_bytes = t3r_pixel_row_bytes(format, SAMPLE_WIDTH), stride = row_bytes + PADDING;
        memset(planes, 0xdd, sizeof planes);
        for (uint32_t p = 0; p < 2; p++) {
            for (uint32_t i = 0; i < row_bytes * t3r_pixel_rows(format, p, SAMPLE_HEIGHT); i++) {
                planes[p][i / row_bytes * stride + i % row_bytes] = sample_byte(f, p, i);
            }
        }
        for (uint32_t i = 0; i < SAMPLE_DEPTH_WIDTH * SAMPLE_DEPTH_HEIGHT; i++) {
            depth[i] = sample_depth(f, i);
        }
        const t3r_recorded_frame frame = {
            .stamp_ns = sample_stamp(f),
            .format = format,
            .width = SAMPLE_WIDTH,
            .height = SAMPLE_HEIGHT,
            .planes = {planes[0], format == T3R_PIXEL_NV12 ? planes[1] : NULL},
            .stride_bytes = {stride, stride},
            .depth = f == 1 ? NULL : depth,
            .depth_width = SAMPLE_DEPTH_WIDTH,
            .depth_height = SAMPLE_DEPTH_HEIGHT,
            .camera = sample_camera(f),
        };
        failed |= t3r_recorder_frame(recorder, &frame);
    }
    failed |= t3r_recorder_end(recorder);
    t3r_chunk_packer_close(packer);
    return failed != 0 ? -1 : 0;
}
