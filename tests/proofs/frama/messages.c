/* SPDX-License-Identifier: Apache-2.0 */
/* The ROS messages of a recording, and the conversion of their numbers: arbitrary bytes. The lengths of texts decide
 * the offsets, so a few lengths are tried one after the other, with every length of the message. The message ends
 * where its array does, so a step past its end is out of bounds. */
#include "messages/fixed_double.h"
#include "messages/message_frame.h"

/* double.c proves this contract. */
/*@ requires fraction: 10 <= fraction_bits <= 50;
    assigns *fixed, \result \from bits, fraction_bits;
    ensures \result == 0 || \result == -1;
    ensures \initialized(fixed); */
int t3r_fixed_from_double(uint64_t bits, uint32_t fraction_bits, int64_t *fixed);

enum { ROOM = 400 };

#define LONGEST UINT32_MAX /* a length that no message has room for */

static uint8_t room[ROOM];

typedef struct message {
    uint8_t *bytes;
    uint32_t count, at;
    bool big_endian;
} message;

static message any_message(uint32_t count, bool big_endian)
{
    message m = {room + ROOM - count, count, 4, big_endian};
    t3r_any_bytes(m.bytes, count);
    if (count > 1) {
        m.bytes[1] = !big_endian;
    }
    return m;
}

/* Appends a 32-bit number if it fits. */
static void put(message *m, uint32_t x)
{
    if (m->at + 4 <= m->count) {
        uint8_t *bytes = m->bytes + m->at;
        for (uint32_t i = 0; i < 4; i++) {
            bytes[i] = (uint8_t)(x >> 8 * (m->big_endian ? 3 - i : i));
        }
    }
    m->at += 4;
}

/* Appends the length of a text, and skips its bytes. */
static void put_text(message *m, uint32_t length)
{
    put(m, length);
    m->at = (m->at + length + 3) / 4 * 4;
}

static void read_image(uint32_t count, uint32_t name, uint32_t encoding)
{
    message m = any_message(count, count % 2 != 0);
    m.at += 8; /* the stamp */
    put_text(&m, name);
    m.at += 8; /* the size */
    put_text(&m, encoding);
    t3r_ros_image image;
    t3r_frame frame;
    size_t data_at;
    if (t3r_ros_read_image_head(m.bytes, m.count, &image, &data_at) == NULL) {
        t3r_message_colour_shape(&image, &frame);
        t3r_message_depth(&image, &frame);
    }
}

static void read_camera_info(uint32_t count, uint32_t name, uint32_t model, uint32_t coefficients)
{
    message m = any_message(count, count % 2 != 0);
    m.at += 8;
    put_text(&m, name);
    m.at += 8;
    put_text(&m, model);
    put(&m, coefficients);
    t3r_ros_camera_info info;
    t3r_camera camera;
    if (t3r_ros_read_camera_info(m.bytes, m.count, &info) == NULL) {
        t3r_message_intrinsics(&info, &camera);
    }
}

static void read_pose(t3r_ros_type type, uint32_t count, uint32_t name, uint32_t child)
{
    message m = any_message(count, count % 2 != 0);
    m.at += 8;
    put_text(&m, name);
    put_text(&m, child);
    t3r_ros_pose pose;
    t3r_camera camera;
    if (t3r_ros_read_pose(type, m.bytes, m.count, &pose) == NULL) {
        t3r_message_pose(&pose, &camera);
    }
}

int main(void)
{
    static const struct {
        uint32_t name, other, coefficients;
    } lengths[] = {{0, 6, 5}, {3, 5, 0}, {2, 7, LONGEST}, {1, LONGEST, 0}, {LONGEST, 0, 0}};
    for (uint32_t i = 0; i < sizeof lengths / sizeof lengths[0]; i++) {
        const uint32_t name = lengths[i].name, other = lengths[i].other;
        for (uint32_t count = 0; count <= 48; count += 3) {
            read_image(count, name, other);
        }
        for (uint32_t count = 13; count <= 90; count += 11) {
            read_pose(T3R_ROS_POSE, count, name, other);
            read_pose(T3R_ROS_ODOMETRY, count, name, other);
        }
        for (uint32_t count = 20; count <= ROOM; count += 31) {
            read_camera_info(count, name, other, lengths[i].coefficients);
        }
    }
    return 0;
}
