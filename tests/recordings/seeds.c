/* SPDX-License-Identifier: Apache-2.0 */
#include "seeds.h"

#include <lz4frame.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <zstd.h>

#include "bag.h"
#include "sample.h"

static int save(const char *folder, const char *name, const uint8_t *bytes, size_t count)
{
    char path[4096];
    snprintf(path, sizeof path, "%s/%s.mcap", folder, name);
    FILE *file = fopen(path, "wb");
    if (file == NULL) {
        return -1;
    }
    int failed = fwrite(bytes, 1, count, file) != count;
    return fclose(file) != 0 || failed ? -1 : 0;
}

/* Returns channels and messages of every type that is read, without magic and Header. */
static bag_bytes records(void)
{
    static const uint8_t pixels[64] = {1, 2, 3};
    static const double p[3] = {1, 2, 3}, q[4] = {0, 0, 0, 1};
    const bag_image colour = {5, 4, 4, 12, "rgb8", false, pixels, 48};
    const bag_image metres = {5, 2, 2, 8, "32FC1", true, pixels, 16};
    const bag_info info = {.stamp_ns = 5,
                           .width = 4,
                           .height = 4,
                           .model = "rational_polynomial",
                           .d = {0.5},
                           .d_count = 8,
                           .k = {20, 0, 2, 0, 20, 2, 0, 0, 1}};
    bag b;
    bag_start(&b);
    size_t head = b.bytes.count;
    b.big_endian = true;
    bag_put_image(&b, bag_channel(&b, "/c/image", "sensor_msgs/msg/Image"), &colour);
    bag_put_image(&b, bag_channel(&b, "/c/depth", "sensor_msgs/msg/Image"), &metres);
    b.big_endian = false;
    bag_put_info(&b, bag_channel(&b, "/c/info", "sensor_msgs/msg/CameraInfo"), &info);
    bag_put_transform(&b, bag_channel(&b, "/tf", "geometry_msgs/msg/TransformStamped"), 5, p, q);
    bag_bytes result;
    bag_bytes_start(&result);
    bag_append(&result, b.bytes.data + head, b.bytes.count - head);
    bag_free(&b);
    return result;
}

static int save_chunked(const char *folder, const char *name, const char *compression, const bag_bytes *content,
                        const uint8_t *packed, size_t packed_bytes)
{
    bag b;
    bag_start(&b);
    bag_metadata(&b, "trim3r", "depth_unit", "0.001");
    t3r_mcap_record(&b.out, T3R_MCAP_CHUNK, 8 + 8 + 8 + 4 + 4 + strlen(compression) + 8 + packed_bytes);
    t3r_mcap_put_u64(&b.out, 5);
    t3r_mcap_put_u64(&b.out, 5);
    t3r_mcap_put_u64(&b.out, content->count);
    t3r_mcap_put_u32(&b.out, 0);
    t3r_mcap_put_text(&b.out, t3r_text_of(compression));
    t3r_mcap_put_u64(&b.out, packed_bytes);
    t3r_mcap_put_raw(&b.out, packed, packed_bytes);
    bag_metadata(&b, "trim3r_triplets", "triplets", "0,0,0");
    int status = save(folder, name, b.bytes.data, b.bytes.count);
    bag_free(&b);
    return status;
}

/* Puts one transform of `child` in `parent`, at a quarter to its right. */
static void put_transform(bag *b, uint16_t channel, int64_t stamp_ns, const char *parent, const char *child)
{
    bag_cdr cdr;
    bag_cdr_start(&cdr, false);
    bag_u32(&cdr, 1);
    bag_header(&cdr, stamp_ns, parent);
    bag_string(&cdr, child);
    for (uint32_t i = 0; i < 7; i++) {
        bag_f64(&cdr, i == 0 ? 0.25 : i == 6 ? 1 : 0);
    }
    bag_message(b, channel, stamp_ns, cdr.bytes.data, cdr.bytes.count);
    bag_bytes_free(&cdr.bytes);
}

/* Saves what import alone reads: transforms that move, depth of another lens, a compressed image. */
static int save_rig(const char *folder)
{
    static const uint8_t pixels[64] = {1, 2, 3, 4, 5, 6, 7, 8};
    const bag_image colour = {2000, 4, 4, 12, "rgb8", false, pixels, 48},
                    depth = {2000, 4, 4, 8, "16UC1", false, pixels, 32};
    bag_info info = {
        .stamp_ns = 2000, .width = 4, .height = 4, .model = "plumb_bob", .k = {20, 0, 2, 0, 20, 2, 0, 0, 1}};
    bag b;
    bag_start(&b);
    bag_put_image(&b, bag_channel(&b, "/c/image", "sensor_msgs/msg/Image"), &colour);
    bag_put_info(&b, bag_channel(&b, "/c/camera_info", "sensor_msgs/msg/CameraInfo"), &info);
    bag_put_image(&b, bag_channel(&b, "/d/image", "sensor_msgs/msg/Image"), &depth);
    info.k[0] = info.k[4] = 16;
    info.d_count = 8;
    info.d[0] = info.d[5] = 0.25;
    info.model = "rational_polynomial";
    bag_put_info(&b, bag_channel(&b, "/d/camera_info", "sensor_msgs/msg/CameraInfo"), &info);
    put_transform(&b, bag_channel(&b, "/tf_static", "tf2_msgs/msg/TFMessage"), 1000, "body", "optical");
    uint16_t tf = bag_channel(&b, "/tf", "tf2_msgs/msg/TFMessage");
    put_transform(&b, tf, 1000, "map", "body");
    put_transform(&b, tf, 3000, "map", "body");
    bag_cdr cdr;
    bag_cdr_start(&cdr, false);
    bag_header(&cdr, 2000, "optical");
    bag_string(&cdr, "jpeg");
    bag_u32(&cdr, 8);
    bag_append(&cdr.bytes, "\xff\xd8\xff\xe0\0\x04\0", 8);
    bag_message(&b, bag_channel(&b, "/e/compressed", "sensor_msgs/msg/CompressedImage"), 2000, cdr.bytes.data,
                cdr.bytes.count);
    bag_bytes_free(&cdr.bytes);
    int status = save(folder, "rig", b.bytes.data, b.bytes.count);
    bag_free(&b);
    return status;
}

int seeds_write(const char *folder)
{
    static const t3r_pixel_format formats[] = {T3R_PIXEL_GREY, T3R_PIXEL_YUYV, T3R_PIXEL_NV12};
    static const char *const names[] = {"grey", "yuyv", "nv12"};
    int failed = 0;
    for (size_t i = 0; i < sizeof formats / sizeof formats[0]; i++) {
        bag_bytes bytes;
        bag_bytes_start(&bytes);
        failed |= sample_write(bag_sink(&bytes), formats[i], SAMPLE_UNCHUNKED);
        char cut[16];
        snprintf(cut, sizeof cut, "%s_cut", names[i]);
        failed |= save(folder, names[i], bytes.data, bytes.count);
        failed |= save(folder, cut, bytes.data, bytes.count * 6 / 10);
        bag_bytes_free(&bytes);
    }
    for (uint32_t storage = 0; storage < SAMPLE_UNCHUNKED; storage++) {
        bag_bytes bytes;
        bag_bytes_start(&bytes);
        char name[16];
        snprintf(name, sizeof name, "ours_%s", sample_storages[storage]);
        failed |= sample_write(bag_sink(&bytes), T3R_PIXEL_RGB24, storage);
        failed |= save(folder, name, bytes.data, bytes.count);
        bag_bytes_free(&bytes);
    }
    failed |= save_rig(folder);
    bag_bytes content = records();
    size_t room = LZ4F_compressFrameBound(content.count, NULL) + ZSTD_compressBound(content.count);
    uint8_t *packed = malloc(room);
    if (packed == NULL) {
        abort();
    }
    failed |= save_chunked(folder, "plain_chunk", "", &content, content.data, content.count);
    size_t count = LZ4F_compressFrame(packed, room, content.data, content.count, NULL);
    failed |= save_chunked(folder, "lz4_chunk", "lz4", &content, packed, count);
    count = ZSTD_compress(packed, room, content.data, content.count, 1);
    failed |= save_chunked(folder, "zstd_chunk", "zstd", &content, packed, count);
    free(packed);
    bag_bytes_free(&content);
    return failed != 0 ? -1 : 0;
}
