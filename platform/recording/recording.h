/* SPDX-License-Identifier: Apache-2.0 */
/* Recordings: MCAP files of ROS 2 messages in CDR. For hosts: this reader uses the heap. */
#ifndef T3R_PLATFORM_RECORDING_H
#define T3R_PLATFORM_RECORDING_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "host/sink.h"
#include "host/text.h"
#include "mcap/packer.h"
#include "messages/fixed_camera.h"
#include "trim3r_capture.h"

struct t3r_ros_image; /* messages/ros_messages.h */
struct t3r_ros_camera_info;

typedef struct t3r_triplet {
    uint32_t context[2];
    uint32_t target;
} t3r_triplet;

/* ---- reading ------------------------------------------------------------------------------------- */

/* The contents that are read, whatever program wrote the file:
 *   colour  sensor_msgs/Image in rgb8, bgr8 (8UC3), mono8, yuv422_yuy2 (yuyv), yuv422 (uyvy) or nv12 (Y plane, then UV,
 *           rows of `step` bytes); with a decoder also rgba8, bgra8, 8UC4, bayer, and sensor_msgs/CompressedImage
 *   depth   16UC1 or mono16: steps of the unit in metadata "trim3r", else of 0.001; 32FC1 metres become steps of
 *           that unit: to Q40, then divided, both round-half-even; NaN, infinity, zero, what lies behind the
 *           camera or beyond 65535 steps is 0
 *   intrinsics  sensor_msgs/CameraInfo: K and D; plumb_bob, equidistant, and rational_polynomial when its terms beyond
 *           the fifth are 0; all D zero and not equidistant is T3R_DISTORTION_NONE. A topic with the word "rect" has
 *           rectified images: P and no distortion
 *   pose    geometry_msgs/PoseStamped, TransformStamped (child to frame), PoseWithCovarianceStamped or
 *           nav_msgs/Odometry: camera to world
 * For each of these, types, names, frames and intrinsics vote (recording_choice.c); a t3r_recording_choice names topics
 * instead. camera_info must share the frame of its images. Topics whose names say infrared, confidence or the like are
 * no depth, and goals are no poses. If topics of several cameras are equally good, none is used; of colour the first
 * one is, and t3r_recording_asks() lists them. Several channels of one topic are one stream. A message or transform
 * that cannot be read is left out and counted, unless the choice is strict.
 *
 * A colour image is paired with the depth and pose of the same header.stamp, else with the nearest within
 * 20 ms, unless they have exactly another colour image's stamp. Intrinsics hold from their stamp on, the first ones
 * also before. A stamp of 0 means the log time. If the stamps of the colour images go back or most of them repeat, or
 * those of depth or poses go back or are all the same, log times replace all stamps.
 *
 * Doubles become fixed point by t3r_fixed_from_double(): intrinsics Q16, distortion Q24, position Q32, rotation Q30;
 * the depth unit is decimal text, to Q40. NaN and values outside the ranges of t3r_camera are refused. */

typedef struct t3r_recording t3r_recording;

/* Reads and indexes a whole recording: an MCAP file, or one packed with zstd; or a folder of rosbag2, whose files are
 * read in the order of metadata.yaml as one. Returns NULL with "what, where" in error[] on failure. A file that was cut
 * off is read up to its last complete message; t3r_recording_note() then says so. */
t3r_recording *t3r_recording_open(const char *path, char *error, size_t error_bytes);
/* Reads a recording in memory, which must outlive it (the fuzzers use this). */
t3r_recording *t3r_recording_parse(const uint8_t *bytes, size_t count, char *error, size_t error_bytes);

/* Names of topics; NULL: chosen as above. */
typedef struct t3r_recording_choice {
    const char *colour, *depth, *pose, *camera_info;
    const char *depth_camera_info; /* NULL: the one below depth's prefix, if this is not colour's */
    const t3r_camera *intrinsics;  /* of all colour images; NULL: those of camera_info */
    bool strict;                   /* refuse a recording with a message that cannot be read */
    int64_t pair_ns;               /* largest distance of depth and pose from colour; 0: 20 ms */
    uint64_t depth_unit_q40;       /* a step of 16-bit depth where the file does not state it; 0: 0.001 */
} t3r_recording_choice;
/* Opens a recording by a choice; fails if a name is no topic of that kind. */
t3r_recording *t3r_recording_open_chosen(const char *path, const t3r_recording_choice *choice, char *error,
                                         size_t error_bytes);

/* A decoded sensor_msgs/CompressedImage: rows without gaps of RGB24 or GREY, or of Z16 in the recording's unit. */
typedef struct t3r_decoded_image {
    uint32_t width, height;
    uint32_t whole_width, whole_height; /* of colour before it was reduced */
    uint32_t reduction;                 /* squares of so many pixels along a side became one of colour */
    t3r_pixel_format format;            /* for colour */
    const uint8_t *rows;                /* owned by the decoder; valid until it decodes the next image of that kind */
} t3r_decoded_image;
/* Decodes `count` bytes in the format that the message names. Returns 0, or -1 with a reason. Without a decoder, frames
 * with such images are refused: a recording must replay the same everywhere, so import decodes them first. */
typedef struct t3r_image_decoder {
    int (*decode)(void *user, t3r_text format, const uint8_t *bytes, size_t count, bool depth, uint64_t unit_q40,
                  t3r_decoded_image *out, char *error, size_t error_bytes);
    /* Converts an image of an encoding for which t3r_pixel_is_converted() holds, or with a side above T3R_MAX_SIDE. */
    int (*convert)(void *user, const struct t3r_ros_image *image, t3r_decoded_image *out, char *error,
                   size_t error_bytes);
    /* Redraws a frame's colour, and its depth if that is of the same view, for a camera without the lens's distortion,
     * which no t3r_camera holds. */
    int (*straighten)(void *user, const struct t3r_ros_camera_info *info, t3r_frame *frame, bool depth, char *error,
                      size_t error_bytes);
    void *user;
} t3r_image_decoder;
void t3r_recording_set_decoder(t3r_recording *recording, t3r_image_decoder decoder);
void t3r_recording_close(t3r_recording *recording);

uint32_t t3r_recording_frame_count(const t3r_recording *recording);
/* Reads frame `index`; its memory lives as long as the recording. Returns T3R_CAPTURE_FRAME, or T3R_CAPTURE_FAILED
 * with a reason in error[]. Depth stored as floats or big-endian is converted once and kept, so two threads must not
 * read at the same time. */
int t3r_recording_frame(const t3r_recording *recording, uint32_t index, t3r_capture_frame *frame, char *error,
                        size_t error_bytes);

/* Does the same, but leaves out depth or a pose that cannot be read, with the reasons in lost[] ("" if nothing is left
 * out). */
int t3r_recording_frame_readable(const t3r_recording *recording, uint32_t index, t3r_capture_frame *frame, char *lost,
                                 size_t lost_bytes, char *error, size_t error_bytes);

/* Gives frame `index` this pose, replacing the file's if there is one: for estimated poses. Camera to world, as in
 * t3r_camera. Returns 0, or -1 when memory is out or there is no such frame. */
int t3r_recording_set_pose(t3r_recording *recording, uint32_t index, const int64_t position_q32[3],
                           const int32_t rotation_q30[4]);

/* Returns the number of triplets. Triplets that name a frame outside the recording are dropped, with a remark in the
 * note. */
uint32_t t3r_recording_triplet_count(const t3r_recording *recording);
t3r_triplet t3r_recording_triplet(const t3r_recording *recording, uint32_t index);

/* The place where a truncated file stops, and the messages before it. */
typedef struct t3r_recording_cut {
    bool cut;
    const char *file;            /* the name of the first such file of several, else "" */
    uint64_t offset, file_bytes; /* offset: everything after it is lost */
    uint64_t messages;
} t3r_recording_cut;
t3r_recording_cut t3r_recording_cut_of(const t3r_recording *recording);
/* Returns why the frames of a bag from elsewhere need import, or "": its images are compressed, its depth is from
 * another camera, or its poses are transforms or belong to another frame, unless t3r_recording_set_pose() set some. */
const char *t3r_recording_import_reason(const t3r_recording *recording);
/* Returns "", or which topics are equally good for the colour images: "..., name one with --colour-topic". The first
 * one is taken then, for a look at the recording. */
const char *t3r_recording_asks(const t3r_recording *recording);
/* Returns "" or a remark such as "cut off after 12 of its messages". */
const char *t3r_recording_note(const t3r_recording *recording);
/* Returns the bits epoch of the recording; 0 = not written by trim3r. */
uint32_t t3r_recording_bits_epoch(const t3r_recording *recording);

/* Whether a topic's name says that its images are rectified: P of camera_info holds for them, and no distortion. */
bool t3r_topic_is_rectified(const char *topic);

/* The use of a stream. */
typedef enum t3r_stream_use {
    T3R_USE_NONE,
    T3R_USE_COLOUR,
    T3R_USE_DEPTH,
    T3R_USE_CAMERA_INFO,
    T3R_USE_DEPTH_CAMERA_INFO,
    T3R_USE_POSE,
    T3R_USE_TRANSFORMS, /* only for import */
    T3R_USE_COUNT
} t3r_stream_use;
/* "", "colour", "depth", ... */
extern const char *const t3r_stream_use_names[T3R_USE_COUNT];

typedef struct t3r_stream_info {
    t3r_stream_use use;
    const char *unused; /* why it is not read, or "" */
    bool compressed;    /* its images are files of JPEG or PNG, or in an encoding that import converts */
    bool rectified;     /* its images have no distortion: P of camera_info holds for them */
    uint64_t left_out;  /* messages, or transforms, that cannot be read */
    const char *fault;  /* "at byte N: what is wrong" of the first of them, or "" */
    const char *topic, *schema;
    uint64_t messages;
    int64_t first_ns, last_ns; /* log times */
} t3r_stream_info;
uint32_t t3r_recording_stream_count(const t3r_recording *recording);
t3r_stream_info t3r_recording_stream(const t3r_recording *recording, uint32_t index);
/* Returns the first stream of that use; T3R_NO_STREAM if there is none. */
#define T3R_NO_STREAM SIZE_MAX
size_t t3r_recording_stream_for(const t3r_recording *recording, t3r_stream_use use);

/* A message of a stream whose type trim3r reads (ros_messages.h), in the order of their stamps if the stream is used,
 * else in the file's order. */
typedef struct t3r_recorded_message {
    const uint8_t *data; /* complete and valid: checked when it was indexed */
    size_t bytes;
    int64_t stamp_ns;
} t3r_recorded_message;
uint32_t t3r_recording_message_count(const t3r_recording *recording, size_t stream);
t3r_recorded_message t3r_recording_message(const t3r_recording *recording, size_t stream, uint32_t index);
/* Returns the message of that stream from which frame `index` is read, or NULL data. */
t3r_recorded_message t3r_recording_frame_message(const t3r_recording *recording, uint32_t index, t3r_stream_use use);
/* Counts of the pairing of depth, pose and camera_info with the colour images. */
typedef struct t3r_pairing_info {
    uint32_t frames, with_depth, with_pose, with_intrinsics;
    bool by_log; /* stamps go back or repeat, so that log times stand in their place */
    int64_t worst_depth_gap_ns, worst_pose_gap_ns;
} t3r_pairing_info;
t3r_pairing_info t3r_recording_pairing(const t3r_recording *recording);
/* Returns the clock named in the recording's metadata ("synthetic", "monotonic", ...), or "unknown". */
const char *t3r_recording_clock(const t3r_recording *recording);
/* Returns a step of its 16-bit depth in world units, Q40. */
uint64_t t3r_recording_depth_unit_q40(const t3r_recording *recording);

/* Returns how many samples of depth in metres, in the frames read so far, lie beyond 65535 steps of that unit. They
 * count as no measurement. */
uint64_t t3r_recording_depth_beyond(const t3r_recording *recording);

/* A pose message of the file: camera (or whatever carries the frame) to world. */
typedef struct t3r_recorded_pose {
    int64_t stamp_ns;
    double position[3];
    double rotation[4]; /* w x y z */
} t3r_recorded_pose;
/* Poses of stream `stream`, in the order of their stamps if the stream gives the frames their poses, else in the file's
 * order. The count is 0 when its type is no pose. */
uint32_t t3r_recording_pose_count(const t3r_recording *recording, uint32_t stream);
t3r_recorded_pose t3r_recording_pose(const t3r_recording *recording, uint32_t stream, uint32_t index);

/* ---- writing: no heap, one pass, CRC-checked -------------------------------------------------------------- */

typedef struct t3r_recorded_frame {
    int64_t stamp_ns;
    t3r_pixel_format format;
    uint32_t width, height;
    const uint8_t *planes[2];
    uint32_t stride_bytes[2];
    const uint16_t *depth; /* host order; NULL = none */
    const uint8_t
        *depth_z16; /* used if depth is NULL: little-endian samples, rows depth_stride_bytes apart; NULL = none */
    uint32_t depth_width, depth_height, depth_stride_bytes;
    bool unposed, uncalibrated; /* the camera's pose, or its intrinsics, are unknown and not written */
    t3r_recorded_camera camera;
} t3r_recorded_frame;

/* Allocated by the caller, aligned for uint64_t: t3r_recorder_bytes() bytes, or an array of T3R_RECORDER_BYTES, which
 * is enough on every target. */
typedef struct t3r_recorder t3r_recorder;
#define T3R_RECORDER_BYTES 512
size_t t3r_recorder_bytes(void);

typedef struct t3r_recording_header {
    const char *camera; /* topic prefix, such as "camera": 1..47 of A-Z a-z 0-9 _ and, inside, / */
    const char *source; /* free text: the imported source */
    const char *clock;  /* "synthetic", "monotonic", "boottime", ... */
    double depth_unit;  /* world units per step; stored in Q40; more than 2^-41, less than 128 */
    const t3r_triplet *triplets;
    uint32_t triplet_count;
    bool events; /* the recording also has a topic /<camera>/events: t3r_recorder_event() */
    /* Called with the sink's `user` after each complete message, so that it can be saved; 0 = done. NULL = not
     * called. */
    int (*message_end)(void *user);
    /* Writes messages only, for small writers and for readers that go from front to back. Otherwise, if the sink can be
     * read back, the messages of a frame form a chunk, and a summary has the index for seeking. */
    bool unchunked;
    const t3r_chunk_packer *packer; /* compresses chunks; outlives the recorder. NULL: they are not compressed */
} t3r_recording_header;

/* Return 0, or -1 once the sink has failed; also -1, with nothing written, for an argument outside its range: a frame's
 * stamp must lie in 0 .. 2^31 s, its sides in 2..T3R_MAX_SIDE and be even if the format requires it, its strides must
 * hold a row, and its camera must have the image's size. header and its texts are read during the call only.
 *
 * The image is the last message of its frame, so that a file cut off by power loss holds no image without its pose,
 * intrinsics and depth. */
int t3r_recorder_begin(t3r_recorder *recorder, t3r_sink sink, const t3r_recording_header *header);
int t3r_recorder_frame(t3r_recorder *recorder, const t3r_recorded_frame *frame);
/* Writes a line of text at that time, as rcl_interfaces/msg/Log. Returns -1 also without `events` in the header, or
 * when the text is longer than 1,024 bytes. */
typedef enum t3r_recorder_level {
    T3R_RECORDER_INFO = 20,
    T3R_RECORDER_WARNING = 30,
    T3R_RECORDER_ERROR = 40
} t3r_recorder_level;
int t3r_recorder_event(t3r_recorder *recorder, int64_t stamp_ns, t3r_recorder_level level, const char *text);
/* Return the bytes of the recording so far, and the most that t3r_recorder_end() adds after one more frame or event. */
uint64_t t3r_recorder_offset(const t3r_recorder *recorder);
uint64_t t3r_recorder_end_bytes(const t3r_recorder *recorder);
int t3r_recorder_end(t3r_recorder *recorder);

#endif
