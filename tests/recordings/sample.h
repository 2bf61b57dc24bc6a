/* SPDX-License-Identifier: Apache-2.0 */
/* The sample recording of these tests: small, with every value given by a formula, so that other programs can check
 * it. */
#ifndef T3R_TESTS_SAMPLE_H
#define T3R_TESTS_SAMPLE_H

#include "recording/recording.h"

enum { SAMPLE_FRAMES = 3, SAMPLE_WIDTH = 6, SAMPLE_HEIGHT = 4, SAMPLE_DEPTH_WIDTH = 3, SAMPLE_DEPTH_HEIGHT = 2 };

/* Byte i of plane p of frame f: (7 f + 31 p + 13 i) mod 256, i counting over the rows without padding. */
uint8_t sample_byte(uint32_t frame, uint32_t plane, uint32_t i);
/* Depth sample i of frame f: 1000 + 257 i + 16 f, and 0 for i = 1. */
uint16_t sample_depth(uint32_t frame, uint32_t i);
/* Camera of frame f: stamp f x 33333333 ns + 5 s; fx 100.25 + f, fy 101.5, cx 2.5, cy 1.5 - f; f = 0 no distortion, 1
 * radial-tangential 0.1 -0.2 0.001 0.002 0.05, 2 fisheye 0.01 0.02 -0.03 0.04; position f / 3, -2.5, 1e-3 f; rotation
 * w x y z 0.5, 0.5, -0.5, 0.5 (f = 1: 1 0 0 0). Frame 1 has no depth. */
t3r_recorded_camera sample_camera(uint32_t frame);
int64_t sample_stamp(uint32_t frame);
t3r_triplet sample_triplet(uint32_t index); /* 0: {0, 2; 1}, 1: {1, 0; 2} */

/* Storage of the messages: in chunks by their compression, or without chunks. */
enum { SAMPLE_NONE, SAMPLE_ZSTD, SAMPLE_LZ4, SAMPLE_UNCHUNKED, SAMPLE_STORAGES };
extern const char *const sample_storages[SAMPLE_STORAGES]; /* "none", "zstd", "lz4", "unchunked" */

/* Writes the sample with images in this format; 0, or -1 when the sink failed. */
int sample_write(t3r_sink sink, t3r_pixel_format format, uint32_t storage);

#endif
