/* SPDX-License-Identifier: Apache-2.0 */
/* The reader of recordings for firmware: records at any place, and rows of any image in them. The source returns
 * arbitrary bytes for any range, also beyond its end. */
#include "recording/frame_reader.c"

#include "messages/fixed_double.h"

/* double.c proves this contract for this fraction. */
/*@ requires fraction: fraction_bits == 40;
    assigns *fixed, \result \from bits, fraction_bits;
    ensures \result == 0 || \result == -1;
    ensures \initialized(fixed); */
int t3r_fixed_from_float(uint32_t bits, uint32_t fraction_bits, int64_t *fixed);

/* Eva does not know the library function's result. */
int memcmp(const void *a, const void *b, size_t count)
{
    const uint8_t *left = a, *right = b;
    size_t i = 0;
    while (i < count && left[i] == right[i]) {
        i++;
    }
    return i < count ? left[i] - right[i] : 0;
}

enum { ROOM = 64 };

static uint8_t colour[ROOM], depth[ROOM];

/*@ requires room: count == 0 || \valid((uint8_t *)bytes + (0 .. count - 1));
    assigns \result, ((uint8_t *)bytes)[0 .. count - 1] \from offset, Frama_C_entropy_source;
    ensures filled: \initialized((uint8_t *)bytes + (0 .. count - 1)); */
static int any_bytes(void *user, uint64_t offset, void *bytes, size_t count);

static t3r_frame_reader open_reader(void)
{
    t3r_frame_reader reader;
    const t3r_byte_source source = {any_bytes, NULL, t3r_any_unsigned(0, UINT64_MAX)};
    t3r_frame_reader_open(&reader, &source, colour, ROOM, depth, ROOM);
    reader.error = NULL;
    return reader;
}

static void records(void)
{
    t3r_frame_reader reader = open_reader();
    record r;
    instant now = {0};
    reader.at = t3r_any_unsigned(0, UINT64_MAX);
    reader.chunk_end = t3r_any_unsigned(0, UINT64_MAX);
    reader.schema_count = (uint32_t)t3r_any(0, T3R_FRAME_READER_NAMES);
    t3r_any_bytes((unsigned char *)reader.schemas, sizeof reader.schemas);
    if (read_record(&reader, &r) == 1) {
        enter_chunk(&reader, &r);
        read_schema(&reader, &r);
        read_stamp(&reader, &r, t3r_any_unsigned(0, UINT64_MAX), &now.stamp_ns);
    }
}

/* The number of bytes requested follows from the rows and the step. */
static void colour_rows(uint32_t count, uint32_t step, t3r_pixel_format format)
{
    t3r_frame_reader reader = open_reader();
    t3r_frame frame = {0};
    reader.format = format;
    reader.colour_image.message.height = (uint32_t)t3r_any(2, T3R_MAX_SIDE);
    reader.colour_image.message.step = step;
    t3r_frame_reader_rows(&reader, &frame, (uint32_t)t3r_any(0, UINT32_MAX), count, 0, 0);
}

/* t3r_message_depth() checks that a step is at least a row's bytes. */
static void depth_rows(uint32_t count, uint32_t width, uint32_t padding, const char *encoding)
{
    t3r_frame_reader reader = open_reader();
    t3r_frame frame = {0};
    t3r_ros_image *message = &reader.depth_image.message;
    reader.depth_image.at = t3r_any_unsigned(1, UINT64_MAX);
    *message =
        (t3r_ros_image){.height = (uint32_t)t3r_any(2, T3R_MAX_SIDE), .width = width, .is_bigendian = t3r_any(0, 1)};
    message->encoding = t3r_text_of(encoding);
    message->step = width * (t3r_message_is_metres(message) ? 4 : 2) + padding;
    reader.depth_unit_q40 = t3r_any_unsigned(1, (UINT64_C(1) << 47) - 1);
    t3r_frame_reader_rows(&reader, &frame, 0, 0, (uint32_t)t3r_any(0, UINT32_MAX), count);
}

int main(void)
{
    records();
    for (uint32_t count = 0; count <= 6; count++) {
        for (uint32_t step = 2; step <= ROOM + 1; step += 7) {
            colour_rows(count, step, T3R_PIXEL_RGB24);
            colour_rows(count, step, T3R_PIXEL_NV12);
        }
        for (uint32_t width = 2; width <= ROOM / 4 + 1; width += 4) {
            depth_rows(count, width, 0, "32FC1");
            depth_rows(count, width, 3, "32FC1");
            depth_rows(count, width, 1, "16UC1");
        }
    }
    return 0;
}
