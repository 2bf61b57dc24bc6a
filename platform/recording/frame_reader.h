/* Frames of a recording, one after the other, without a heap: for firmware.
 *
 * It reads what trim3r records and imports: chunks that are not compressed, or none, and images as pixels. The messages
 * of one instant have one header.stamp and follow one another. Depth and pose of another stamp than their colour
 * image's are passed over; `trim3r import` pairs them. CRCs are not checked, because most records are passed over. */
#ifndef T3R_PLATFORM_FRAME_READER_H
#define T3R_PLATFORM_FRAME_READER_H

#include "capture/capture.h"
#include "messages/ros_messages.h"

/* Where bytes come from: flash, a card, a debugger's host. */
typedef struct t3r_byte_source {
    /* Reads `count` bytes from `offset` on, all of which the source has. 0 = done. */
    int (*read)(void *user, uint64_t offset, void *bytes, size_t count);
    void *user;
    uint64_t bytes; /* that it has */
} t3r_byte_source;

#define T3R_FRAME_READER_NAMES 16u        /* schemas and channels that are told apart, each */
#define T3R_FRAME_READER_SMALL_BYTES 1024 /* of all records but images; longer ones are passed over */

typedef struct t3r_frame_reader_name {
    uint16_t id;
    uint8_t type; /* a t3r_ros_type */
} t3r_frame_reader_name;

/* An image in the source. */
typedef struct t3r_frame_reader_image {
    uint64_t at; /* of its first row */
    t3r_ros_image message;
} t3r_frame_reader_image;

/* The caller's to place; its fields are the reader's own. */
typedef struct t3r_frame_reader {
    t3r_byte_source source;
    uint8_t *colour, *depth;
    size_t colour_room, depth_room;
    uint64_t at;        /* where the next record starts */
    uint64_t chunk_end; /* of the chunk that it stands in; 0: in none */
    t3r_frame_reader_name schemas[T3R_FRAME_READER_NAMES], channels[T3R_FRAME_READER_NAMES];
    uint32_t schema_count, channel_count;
    int32_t colour_channel, depth_channel; /* -1 until one is met */
    uint64_t depth_unit_q40;
    uint32_t frames;
    t3r_frame_reader_image colour_image, depth_image; /* of the frame at hand */
    t3r_pixel_format format;
    bool has_intrinsics;
    uint32_t camera_width, camera_height;
    t3r_camera camera; /* intrinsics of the last message that had them */
    const char *error;
    uint8_t small[T3R_FRAME_READER_SMALL_BYTES];
} t3r_frame_reader;

/* Begins at the front of the source. `colour` and `depth` hold the rows of an image that are read at once, as they lie
 * in the source; `depth` may be NULL with no room, and depth is passed over. 0, or -1: t3r_frame_reader's `error` says
 * why. */
int t3r_frame_reader_open(t3r_frame_reader *reader, const t3r_byte_source *source, uint8_t *colour, size_t colour_room,
                          uint8_t *depth, size_t depth_room);

/* The next frame, whose planes lie in the two buffers until the next call. T3R_CAPTURE_FRAME; T3R_CAPTURE_END: there
 * are no more, or the file was cut off here; T3R_CAPTURE_FAILED: `error` says why, and there are no more. */
int t3r_frame_reader_next(t3r_frame_reader *reader, t3r_capture_frame *frame);

/* The same without a row: planes and depth are NULL, and depth_height is 0 where there is none. */
int t3r_frame_reader_find(t3r_frame_reader *reader, t3r_capture_frame *frame);

/* Rows row..row + rows - 1 of the colour image of the frame that was found last, and depth_row..depth_row + depth_rows
 * - 1 of its depth image, as t3r_add_rows() takes them: they come into the two buffers, and the planes of `frame` begin
 * with them. 0, or -1 as above. */
int t3r_frame_reader_rows(t3r_frame_reader *reader, t3r_frame *frame, uint32_t row, uint32_t rows, uint32_t depth_row,
                          uint32_t depth_rows);

#endif
