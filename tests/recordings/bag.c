/* SPDX-License-Identifier: Apache-2.0 */
#include "bag.h"

#include <stdlib.h>
#include <string.h>

void bag_bytes_start(bag_bytes *bytes)
{
    *bytes = (bag_bytes){.room_left = SIZE_MAX};
}

void bag_bytes_free(bag_bytes *bytes)
{
    free(bytes->data);
    *bytes = (bag_bytes){0};
}

void bag_append(bag_bytes *bytes, const void *data, size_t count)
{
    if (bytes->count + count > bytes->capacity) {
        bytes->capacity = (bytes->count + count) * 2;
        bytes->data = realloc(bytes->data, bytes->capacity);
        if (bytes->data == NULL) {
            abort();
        }
    }
    memcpy(bytes->data + bytes->count, data, count);
    bytes->count += count;
}

static int append(void *user, const void *data, size_t count)
{
    bag_bytes *bytes = user;
    if (count > bytes->room_left) {
        return -1;
    }
    bytes->room_left -= count;
    bag_append(bytes, data, count);
    return 0;
}

static int read_back(void *user, uint64_t offset, void *data, size_t count)
{
    const bag_bytes *bytes = user;
    if (offset > bytes->count || bytes->count - offset < count) {
        return -1;
    }
    memcpy(data, bytes->data + offset, count);
    return 0;
}

t3r_sink bag_sink(bag_bytes *bytes)
{
    return (t3r_sink){append, bytes, read_back};
}

void bag_cdr_start(bag_cdr *cdr, bool big_endian)
{
    bag_bytes_start(&cdr->bytes);
    cdr->big_endian = big_endian;
    const uint8_t encapsulation[4] = {0, big_endian ? 0 : 1, 0, 0};
    bag_append(&cdr->bytes, encapsulation, 4);
}

static void put_number(bag_cdr *cdr, uint64_t x, uint32_t size)
{
    while ((cdr->bytes.count - 4) % size != 0) {
        bag_append(&cdr->bytes, "\xee", 1); /* padding may hold anything */
    }
    for (uint32_t i = 0; i < size; i++) {
        uint32_t shift = 8 * (cdr->big_endian ? size - 1 - i : i);
        uint8_t byte = (uint8_t)(x >> shift);
        bag_append(&cdr->bytes, &byte, 1);
    }
}

void bag_u8(bag_cdr *cdr, uint8_t x)
{
    put_number(cdr, x, 1);
}

void bag_u32(bag_cdr *cdr, uint32_t x)
{
    put_number(cdr, x, 4);
}

void bag_f64(bag_cdr *cdr, double x)
{
    uint64_t bits;
    memcpy(&bits, &x, sizeof bits);
    put_number(cdr, bits, 8);
}

void bag_string(bag_cdr *cdr, const char *text)
{
    bag_u32(cdr, (uint32_t)strlen(text) + 1);
    bag_append(&cdr->bytes, text, strlen(text) + 1);
}

void bag_header(bag_cdr *cdr, int64_t stamp_ns, const char *frame_id)
{
    int64_t seconds = stamp_ns / 1000000000 - (stamp_ns % 1000000000 < 0);
    bag_u32(cdr, (uint32_t)(int32_t)seconds);
    bag_u32(cdr, (uint32_t)(stamp_ns - seconds * 1000000000));
    bag_string(cdr, frame_id);
}

void bag_start(bag *b)
{
    *b = (bag){0};
    bag_bytes_start(&b->bytes);
    t3r_mcap_begin(&b->out, bag_sink(&b->bytes), t3r_text_of(""), t3r_text_of("by hand"));
}

uint16_t bag_channel(bag *b, const char *topic, const char *schema)
{
    uint16_t id = (uint16_t)(b->channels + 40);
    b->channels++;
    t3r_mcap_schema(&b->out, id, t3r_text_of(schema), t3r_text_of("ros2msg"), t3r_text_of(""));
    t3r_mcap_channel(&b->out, id, id, t3r_text_of(topic), t3r_text_of("cdr"), NULL, 0);
    return id;
}

void bag_message(bag *b, uint16_t channel, int64_t log_ns, const void *data, size_t count)
{
    t3r_mcap_message(&b->out, channel, 0, (uint64_t)log_ns, count);
    t3r_mcap_put_raw(&b->out, data, count);
}

static void put_cdr(bag *b, uint16_t channel, int64_t log_ns, bag_cdr *cdr)
{
    bag_message(b, channel, log_ns, cdr->bytes.data, cdr->bytes.count);
    bag_bytes_free(&cdr->bytes);
}

void bag_put_image(bag *b, uint16_t channel, const bag_image *image)
{
    bag_cdr cdr;
    bag_cdr_start(&cdr, b->big_endian);
    bag_header(&cdr, image->stamp_ns, "optical");
    bag_u32(&cdr, image->height);
    bag_u32(&cdr, image->width);
    bag_string(&cdr, image->encoding);
    bag_u8(&cdr, image->is_bigendian);
    bag_u32(&cdr, image->step);
    bag_u32(&cdr, image->data_bytes);
    bag_append(&cdr.bytes, image->data, image->data_bytes);
    put_cdr(b, channel, 7, &cdr);
}

void bag_put_info(bag *b, uint16_t channel, const bag_info *info)
{
    static const double one_r[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};
    bag_cdr cdr;
    bag_cdr_start(&cdr, b->big_endian);
    bag_header(&cdr, info->stamp_ns, "optical");
    bag_u32(&cdr, info->height);
    bag_u32(&cdr, info->width);
    bag_string(&cdr, info->model);
    bag_u32(&cdr, info->d_count);
    for (uint32_t i = 0; i < info->d_count && i < 16; i++) {
        bag_f64(&cdr, info->d[i]);
    }
    for (uint32_t i = 0; i < 9; i++) {
        bag_f64(&cdr, info->k[i]);
    }
    for (uint32_t i = 0; i < 9; i++) {
        bag_f64(&cdr, one_r[i]);
    }
    for (uint32_t i = 0; i < 12; i++) {
        bag_f64(&cdr, 0);
    }
    bag_u32(&cdr, info->binning);
    bag_u32(&cdr, info->binning);
    for (uint32_t i = 0; i < 4; i++) {
        bag_u32(&cdr, 0);
    }
    bag_u8(&cdr, 0);
    put_cdr(b, channel, 7, &cdr);
}

static void put_rigid(bag *b, uint16_t channel, int64_t stamp_ns, const char *child, const double position[3],
                      const double rotation[4])
{
    bag_cdr cdr;
    bag_cdr_start(&cdr, b->big_endian);
    bag_header(&cdr, stamp_ns, "map");
    if (child != NULL) {
        bag_string(&cdr, child);
    }
    for (uint32_t i = 0; i < 3; i++) {
        bag_f64(&cdr, position[i]);
    }
    for (uint32_t i = 0; i < 4; i++) {
        bag_f64(&cdr, rotation[i]);
    }
    put_cdr(b, channel, 7, &cdr);
}

void bag_put_pose(bag *b, uint16_t channel, int64_t stamp_ns, const double position[3], const double rotation[4])
{
    put_rigid(b, channel, stamp_ns, NULL, position, rotation);
}

void bag_put_transform(bag *b, uint16_t channel, int64_t stamp_ns, const double position[3], const double rotation[4])
{
    put_rigid(b, channel, stamp_ns, "optical", position, rotation);
}

void bag_metadata(bag *b, const char *name, const char *key, const char *value)
{
    const t3r_mcap_pair pair = {t3r_text_of(key), t3r_text_of(value)};
    t3r_mcap_metadata(&b->out, t3r_text_of(name), &pair, 1);
}

void bag_finish(bag *b)
{
    t3r_mcap_data_end(&b->out);
    t3r_mcap_finish(&b->out, 0, 0);
}

void bag_free(bag *b)
{
    bag_bytes_free(&b->bytes);
}
