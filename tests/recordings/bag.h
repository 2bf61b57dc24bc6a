/* SPDX-License-Identifier: Apache-2.0 */
/* Recordings assembled for the tests: MCAP files in memory, with CDR of either byte order, as a foreign writer might
 * make them. Independent of platform/messages/cdr.c and of the recorder. */
#ifndef T3R_TESTS_BAG_H
#define T3R_TESTS_BAG_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "mcap/mcap_writer.h"
#include "recording/recording.h"

/* Growing bytes. As a sink it fails once `room_left` bytes are used; the earlier bytes can be read back. */
typedef struct bag_bytes {
    uint8_t *data;
    size_t count, capacity;
    size_t room_left;
} bag_bytes;

void bag_bytes_start(bag_bytes *bytes);
void bag_bytes_free(bag_bytes *bytes);
void bag_append(bag_bytes *bytes, const void *data, size_t count);
t3r_sink bag_sink(bag_bytes *bytes);

/* CDR */
typedef struct bag_cdr {
    bag_bytes bytes;
    bool big_endian;
} bag_cdr;

void bag_cdr_start(bag_cdr *cdr, bool big_endian);
void bag_u8(bag_cdr *cdr, uint8_t x);
void bag_u32(bag_cdr *cdr, uint32_t x);
void bag_f64(bag_cdr *cdr, double x);
void bag_string(bag_cdr *cdr, const char *text);
void bag_header(bag_cdr *cdr, int64_t stamp_ns, const char *frame_id);

/* Messages; fields as in ROS. */
typedef struct bag_image {
    int64_t stamp_ns;
    uint32_t width, height, step;
    const char *encoding;
    bool is_bigendian;
    const void *data;
    uint32_t data_bytes;
} bag_image;

typedef struct bag_info {
    int64_t stamp_ns;
    uint32_t width, height;
    const char *model;
    double d[16];
    uint32_t d_count;
    double k[9];
    uint32_t binning;
} bag_info;

/* An MCAP file under construction; channels get ids in the order in which they are added. */
typedef struct bag {
    bag_bytes bytes;
    t3r_mcap_writer out;
    uint16_t channels;
    bool big_endian;
} bag;

void bag_start(bag *b);
uint16_t bag_channel(bag *b, const char *topic, const char *schema);
void bag_message(bag *b, uint16_t channel, int64_t log_ns, const void *data, size_t count);
void bag_put_image(bag *b, uint16_t channel, const bag_image *image);
void bag_put_info(bag *b, uint16_t channel, const bag_info *info);
/* rotation: x y z w */
void bag_put_pose(bag *b, uint16_t channel, int64_t stamp_ns, const double position[3], const double rotation[4]);
void bag_put_transform(bag *b, uint16_t channel, int64_t stamp_ns, const double position[3], const double rotation[4]);
void bag_metadata(bag *b, const char *name, const char *key, const char *value);
/* DataEnd, Footer, magic; without summary. */
void bag_finish(bag *b);
void bag_free(bag *b);

#endif
