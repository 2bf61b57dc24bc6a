/* Recordings: MCAP files of ROS 2 messages in CDR. Host side: this reader uses the heap. */
#ifndef T3R_PLATFORM_RECORDING_H
#define T3R_PLATFORM_RECORDING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>
#include <stdio.h>

#include "capture/capture.h"
#include "host/text.h"

typedef struct t3r_triplet {
    uint32_t context[2];
    uint32_t target;
} t3r_triplet;

/* ---- reading ------------------------------------------------------------------------------------- */

/* What is read, from files of any writer:
 *   colour  the first sensor_msgs/Image topic in rgb8, bgr8, yuv422_yuy2 (yuyv), yuv422 (uyvy) or nv12 (Y plane, then
 *           UV, rows of `step` bytes), else the first sensor_msgs/CompressedImage topic, else the first in mono8
 *   depth   16UC1 or mono16: steps of the unit in metadata "trim3r", else of 0.001; 32FC1 metres become steps of
 *           that unit: to Q40, then divided, both round-half-even; NaN, infinity, nothing, what lies behind the
 *           camera or beyond 65535 steps is 0
 *   intrinsics  sensor_msgs/CameraInfo: K and D; plumb_bob, equidistant, and rational_polynomial when its terms beyond
 *           the fifth are 0; all D zero and not equidistant is T3R_DISTORTION_NONE
 *   pose    geometry_msgs/PoseStamped, TransformStamped (child to frame), PoseWithCovarianceStamped or
 *           nav_msgs/Odometry: camera to world
 * Depth, intrinsics and pose come from the topic below the colour topic's prefix ("/camera/"), else from the only one
 * in the file. Of several depth topics those with the longest beginning in common with the colour topic count, of these
 * the first one in colour's frame, else the first; not compressed before compressed. A t3r_recording_choice names
 * topics instead. Depth and pose pair with the colour image of the same header.stamp, else the nearest within 20 ms,
 * unless that has the very stamp of another colour image;
 * intrinsics hold from their stamp on, the first ones also before. A stamp of 0 means the log time.
 *
 * Doubles become fixed point by t3r_fixed_from_double(): intrinsics Q16, distortion Q24, position Q32, rotation Q30;
 * the depth unit is decimal text, to Q40. What is not a number or outside the ranges of t3r_camera is refused. */

typedef struct t3r_recording t3r_recording;

/* Reads and indexes a whole recording; NULL with "what, where" in error[] on failure. A file that was cut
 * off reads up to its last whole message; t3r_recording_note() then says so. */
t3r_recording *t3r_recording_open(const char *path, char *error, size_t error_bytes);
/* The same from memory, which must outlive the recording (the fuzzers' way in). */
t3r_recording *t3r_recording_parse(const uint8_t *bytes, size_t count, char *error, size_t error_bytes);

/* Topics by their names; NULL: as above. */
typedef struct t3r_recording_choice {
    const char *colour, *depth, *pose, *camera_info;
    const char *depth_camera_info; /* NULL: of another prefix than colour's, the one below depth's */
    int64_t pair_ns;               /* depth and pose are at most so far from colour; 0: 20 ms */
} t3r_recording_choice;
/* Fails also where a name is not that of such a topic. */
t3r_recording *t3r_recording_open_chosen(const char *path, const t3r_recording_choice *choice, char *error,
                                         size_t error_bytes);

/* What a sensor_msgs/CompressedImage holds: rows without gaps of RGB24 or GREY, or of Z16 in the recording's unit. */
typedef struct t3r_decoded_image {
    uint32_t width, height;
    t3r_pixel_format format; /* of colour */
    const uint8_t *rows;     /* the decoder's; valid until it decodes the next image of that kind */
} t3r_decoded_image;
/* Decodes `count` bytes in the format that the message names. 0, or -1 with a reason. Without a decoder, frames with
 * such images are refused: a recording that is replayed is the same everywhere, so import decodes them first. */
typedef struct t3r_image_decoder {
    int (*decode)(void *user, t3r_text format, const uint8_t *bytes, size_t count, bool depth, uint64_t unit_q40,
                  t3r_decoded_image *out, char *error, size_t error_bytes);
    void *user;
} t3r_image_decoder;
void t3r_recording_set_decoder(t3r_recording *recording, t3r_image_decoder decoder);
void t3r_recording_close(t3r_recording *recording);

uint32_t t3r_recording_frame_count(const t3r_recording *recording);
/* Frame `index`; its memory lives as long as the recording. T3R_CAPTURE_FRAME, or T3R_CAPTURE_FAILED with a
 * reason in error[]. Depth that the file holds as floats or big-endian is converted once and kept: not from two threads
 * at the same time. */
int t3r_recording_frame(const t3r_recording *recording, uint32_t index, t3r_capture_frame *frame, char *error,
                        size_t error_bytes);

/* Gives frame `index` this pose from here on, in the place of the file's, if that has one: for poses that were
 * estimated. Camera to world, as t3r_camera holds them. 0, or -1 when memory is out or there is no such frame. */
int t3r_recording_set_pose(t3r_recording *recording, uint32_t index, const int64_t position_q32[3],
                           const int32_t rotation_q30[4]);

/* Triplets that name a frame which the recording does not hold are left out, with a remark in the note. */
uint32_t t3r_recording_triplet_count(const t3r_recording *recording);
t3r_triplet t3r_recording_triplet(const t3r_recording *recording, uint32_t index);

/* Where a file that was cut off stops, and the messages before that place. */
typedef struct t3r_recording_cut {
    bool cut;
    uint64_t offset, file_bytes; /* offset: what is behind it is lost */
    uint64_t messages;
} t3r_recording_cut;
t3r_recording_cut t3r_recording_cut_of(const t3r_recording *recording);
/* Why frames are not to be had as they stand, of a bag that others made, or "": its images are files, its depth is that
 * of another camera, or its poses are transforms or those of another frame, unless t3r_recording_set_pose() gave some.
 */
const char *t3r_recording_import_reason(const t3r_recording *recording);
/* "" or a remark such as "cut off after 12 of its messages". */
const char *t3r_recording_note(const t3r_recording *recording);
/* The bits epoch that the recording was written in; 0 = not written by trim3r. */
uint32_t t3r_recording_bits_epoch(const t3r_recording *recording);

/* What a stream is read for. */
typedef enum t3r_stream_use {
    T3R_USE_NONE,
    T3R_USE_COLOUR,
    T3R_USE_DEPTH,
    T3R_USE_CAMERA_INFO,
    T3R_USE_DEPTH_CAMERA_INFO,
    T3R_USE_POSE,
    T3R_USE_TRANSFORMS, /* by import alone */
    T3R_USE_COUNT
} t3r_stream_use;
/* "", "colour", "depth", ... */
extern const char *const t3r_stream_use_names[T3R_USE_COUNT];

typedef struct t3r_stream_info {
    t3r_stream_use use;
    const char *unused; /* why it is not read; "" where it is */
    bool compressed;    /* its images are files (JPEG, PNG) */
    const char *topic, *schema;
    uint64_t messages;
    int64_t first_ns, last_ns; /* log times */
} t3r_stream_info;
uint32_t t3r_recording_stream_count(const t3r_recording *recording);
t3r_stream_info t3r_recording_stream(const t3r_recording *recording, uint32_t index);
/* The first stream read for that; T3R_NO_STREAM where there is none. */
#define T3R_NO_STREAM SIZE_MAX
size_t t3r_recording_stream_for(const t3r_recording *recording, t3r_stream_use use);

/* The messages of a stream of a type that trim3r reads (ros_messages.h), in the order of their stamps where it is read,
 * else in the file's. */
typedef struct t3r_recorded_message {
    const uint8_t *data; /* whole: it was read once already */
    size_t bytes;
    int64_t stamp_ns;
} t3r_recorded_message;
uint32_t t3r_recording_message_count(const t3r_recording *recording, size_t stream);
t3r_recorded_message t3r_recording_message(const t3r_recording *recording, size_t stream, uint32_t index);
/* The message of that stream that frame `index` is read from, or NULL data. */
t3r_recorded_message t3r_recording_frame_message(const t3r_recording *recording, uint32_t index, t3r_stream_use use);
/* How depth, pose and camera_info were paired to the colour images, counted. */
typedef struct t3r_pairing_info {
    uint32_t frames, with_depth, with_pose, with_intrinsics;
    int64_t worst_depth_gap_ns, worst_pose_gap_ns;
} t3r_pairing_info;
t3r_pairing_info t3r_recording_pairing(const t3r_recording *recording);
/* The clock named in the recording's metadata ("synthetic", "monotonic", ...), or "unknown". */
const char *t3r_recording_clock(const t3r_recording *recording);
/* Steps of its 16-bit depth in world units, Q40. */
uint64_t t3r_recording_depth_unit_q40(const t3r_recording *recording);

/* A pose message as the file holds it: camera (or whatever carries the frame) to world. */
typedef struct t3r_recorded_pose {
    int64_t stamp_ns;
    double position[3];
    double rotation[4]; /* w x y z */
} t3r_recorded_pose;
/* Poses of stream `stream`, in the order of their stamps where it is the stream that poses the frames, else in the
 * file's; 0 when its type is no pose. */
uint32_t t3r_recording_pose_count(const t3r_recording *recording, uint32_t stream);
t3r_recorded_pose t3r_recording_pose(const t3r_recording *recording, uint32_t stream, uint32_t index);

/* ---- writing: no heap, one pass, CRC-checked -------------------------------------------------------------- */

typedef struct t3r_sink {
    /* Appends count bytes; 0 = done. */
    int (*write)(void *user, const void *bytes, size_t count);
    void *user;
    /* `count` of the bytes that were appended, from `offset` on; 0 = done. NULL: they cannot be read back. */
    int (*read)(void *user, uint64_t offset, void *bytes, size_t count);
} t3r_sink;

/* Compresses the records of a chunk, which write() hands over piece by piece between begin() and end(). Each returns 0
 * when done; what end() lends is valid until the next begin(). chunk_packer.h has them. */
typedef struct t3r_chunk_packer {
    const char *name; /* as MCAP names it: "zstd", "lz4" */
    int (*begin)(void *user);
    int (*write)(void *user, const void *bytes, size_t count);
    int (*end)(void *user, const uint8_t **bytes, size_t *count);
    void *user;
} t3r_chunk_packer;

/* The camera as the file holds it: doubles, straight from the source. */
typedef struct t3r_recorded_camera {
    uint32_t width, height;
    double fx, fy, cx, cy; /* pixels; pixel (0, 0) is the centre of the top-left pixel */
    t3r_distortion distortion;
    double coefficients[5];
    double position[3]; /* world units */
    double rotation[4]; /* w x y z, camera to world */
} t3r_recorded_camera;

typedef struct t3r_recorded_frame {
    int64_t stamp_ns;
    t3r_pixel_format format;
    uint32_t width, height;
    const uint8_t *planes[2];
    uint32_t stride_bytes[2];
    const uint16_t *depth; /* NULL = none; host order */
    const uint8_t
        *depth_z16; /* where depth is NULL: little-endian samples, rows depth_stride_bytes apart; NULL = none */
    uint32_t depth_width, depth_height, depth_stride_bytes;
    bool unposed, uncalibrated; /* camera's pose, or its intrinsics, are not known and not written */
    t3r_recorded_camera camera;
} t3r_recorded_frame;

/* Caller-allocated, aligned as uint64_t: t3r_recorder_bytes() of them, or an array of T3R_RECORDER_BYTES, which is
 * enough on every target. */
typedef struct t3r_recorder t3r_recorder;
#define T3R_RECORDER_BYTES 512
size_t t3r_recorder_bytes(void);

typedef struct t3r_recording_header {
    const char *camera; /* topic prefix, "camera" say: 1..47 of A-Z a-z 0-9 _ and, inside, / */
    const char *source; /* free text: what was imported */
    const char *clock;  /* "synthetic", "monotonic", "boottime", ... */
    double depth_unit;  /* world units a step; kept in Q40; more than 2^-41, less than 128 */
    const t3r_triplet *triplets;
    uint32_t triplet_count;
    bool events; /* the recording also has a topic /<camera>/events: t3r_recorder_event() */
    /* Called with the sink's `user` behind each whole message, so that it can be put out of harm's way; 0 = done.
     * NULL = not called. */
    int (*message_end)(void *user);
    /* Messages alone, for writers that need little and readers from front to back. Otherwise, where the sink can be
     * read back, the messages of a frame are a chunk, and a summary has the index that readers seek by. */
    bool unchunked;
    const t3r_chunk_packer *packer; /* of the chunks; outlives the recorder. NULL: they are not compressed */
} t3r_recording_header;

/* 0, or -1 once the sink has failed; also -1, and nothing written, for an argument outside its range: a frame's
 * stamp must lie in 0 .. 2^31 s, its sides in 2..T3R_MAX_SIDE and be even where the format asks for it, its strides
 * hold a row, its camera be of the image's size. header and what it points to are read during the call only.
 *
 * The image is the last message of its frame, so that a file cut off by power loss holds no image without its
 * pose, intrinsics and depth. */
int t3r_recorder_begin(t3r_recorder *recorder, t3r_sink sink, const t3r_recording_header *header);
int t3r_recorder_frame(t3r_recorder *recorder, const t3r_recorded_frame *frame);
/* A line of text of that time, as rcl_interfaces/msg/Log; -1 also without `events` in the header, or when the text is
 * longer than 1,024 bytes. */
typedef enum t3r_recorder_level {
    T3R_RECORDER_INFO = 20,
    T3R_RECORDER_WARNING = 30,
    T3R_RECORDER_ERROR = 40
} t3r_recorder_level;
int t3r_recorder_event(t3r_recorder *recorder, int64_t stamp_ns, t3r_recorder_level level, const char *text);
/* Bytes of the recording so far, and the most that t3r_recorder_end() adds behind one more frame or event. */
uint64_t t3r_recorder_offset(const t3r_recorder *recorder);
uint64_t t3r_recorder_end_bytes(const t3r_recorder *recorder);
int t3r_recorder_end(t3r_recorder *recorder);

/* A sink that appends to a stdio stream, and reads it back where it is a file open for both. */
t3r_sink t3r_file_sink(FILE *file);

#endif
