/* SPDX-License-Identifier: Apache-2.0 */
/* Reads frames of a recording in order, without a heap: for firmware.
 *
 * It reads recordings by trim3r's recorder and import: uncompressed chunks or none, and images as pixels. The messages
 * of one instant share a header.stamp and are consecutive. Depth and pose with another stamp than their colour image's
 * are skipped; `trim3r import` pairs them. CRCs are not checked, because most records are skipped. */
#ifndef T3R_PLATFORM_FRAME_READER_H
#define T3R_PLATFORM_FRAME_READER_H

#include "messages/ros_messages.h"
#include "trim3r_capture.h"

/* A source of bytes: flash, a card, a debugger's host. */
typedef struct t3r_byte_source {
    /* Reads `count` bytes from `offset` on, which lie within the source. Returns 0 when done. */
    int (*read)(void *user, uint64_t offset, void *bytes, size_t count);
    void *user;
    uint64_t bytes; /* size of the source */
} t3r_byte_source;

#define T3R_FRAME_READER_NAMES 16u        /* most schemas and most channels */
#define T3R_FRAME_READER_SMALL_BYTES 1024 /* most bytes of a record that is not an image; longer ones are skipped */

typedef struct t3r_frame_reader_name {
    uint16_t id;
    uint8_t type; /* a t3r_ros_type */
} t3r_frame_reader_name;

/* An image in the source. */
typedef struct t3r_frame_reader_image {
    uint64_t at; /* offset of its first row */
    t3r_ros_image message;
} t3r_frame_reader_image;

/* The reader's state; the caller provides the memory and does not use its fields. */
typedef struct t3r_frame_reader {
    t3r_byte_source source;
    uint8_t *colour, *depth;
    size_t colour_room, depth_room;
    uint64_t at;        /* start of the next record */
    uint64_t chunk_end; /* end of the current chunk; 0: outside of chunks */
    t3r_frame_reader_name schemas[T3R_FRAME_READER_NAMES], channels[T3R_FRAME_READER_NAMES];
    uint32_t schema_count, channel_count;
    int32_t colour_channel, depth_channel; /* -1 until one is found */
    uint64_t depth_unit_q40;
    uint32_t frames;
    t3r_frame_reader_image colour_image, depth_image; /* of the current frame */
    t3r_pixel_format format;
    bool has_intrinsics;
    t3r_camera camera; /* intrinsics of the last message that had them */
    const char *error;
    uint8_t small[T3R_FRAME_READER_SMALL_BYTES];
} t3r_frame_reader;

/* Opens a reader at the start of the source. `colour` and `depth` receive the rows of an image that are read in one
 * call, in the source's layout; with `depth` NULL and no room, depth is skipped. Returns 0, or -1 with the reason in
 * the reader's `error`. */
int t3r_frame_reader_open(t3r_frame_reader *reader, const t3r_byte_source *source, uint8_t *colour, size_t colour_room,
                          uint8_t *depth, size_t depth_room);

/* Reads the next frame, whose planes lie in the two buffers until the next call. Returns T3R_CAPTURE_FRAME;
 * T3R_CAPTURE_END: there are no more, or the file was cut off here; T3R_CAPTURE_FAILED: `error` has the reason, and
 * there are no more. */
int t3r_frame_reader_next(t3r_frame_reader *reader, t3r_capture_frame *frame);

/* Finds the next frame without rows: planes and depth are NULL, and depth_height is 0 if there is no depth. */
int t3r_frame_reader_find(t3r_frame_reader *reader, t3r_capture_frame *frame);

/* Reads rows row..row + rows - 1 of the colour image of the frame found last, and rows depth_row..depth_row +
 * depth_rows - 1 of its depth image, for t3r_add_rows(). They go to the two buffers, and the planes of `frame` begin
 * with them. Returns 0, or -1 with a reason. */
int t3r_frame_reader_rows(t3r_frame_reader *reader, t3r_frame *frame, uint32_t row, uint32_t rows, uint32_t depth_row,
                          uint32_t depth_rows);

#endif
