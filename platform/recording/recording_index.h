/* SPDX-License-Identifier: Apache-2.0 */
/* Shared by the files of the recording reader: the messages of a recording by stream, and each frame's companions. */
#ifndef T3R_PLATFORM_RECORDING_INDEX_H
#define T3R_PLATFORM_RECORDING_INDEX_H

#include <stdbool.h>
#include <stdint.h>

#include "mcap/mcap_reader.h"
#include "messages/ros_messages.h"
#include "recording.h"
#include "recording_bytes.h"
#include "recording_folder.h"

#define T3R_NO_MESSAGE SIZE_MAX
#define T3R_NOTE_BYTES 512
#define T3R_UNUSED_BYTES 192
#define T3R_ASKS_BYTES 512

typedef struct t3r_indexed_message {
    const uint8_t *data;
    size_t bytes;
    int64_t stamp_ns; /* header.stamp, or the log time if that is 0 ("unset"); |stamp_ns| <= 2^62 */
    int64_t log_ns;
    uint32_t order; /* in its stream */
    uint32_t file;  /* of the recording's files */
    t3r_mcap_place place;
} t3r_indexed_message;

typedef enum t3r_stream_role {
    T3R_STREAM_OTHER,
    T3R_STREAM_COLOUR,
    T3R_STREAM_DEPTH,
    T3R_STREAM_CAMERA_INFO,
    T3R_STREAM_POSE,
    T3R_STREAM_TF
} t3r_stream_role;

/* A channel. Messages are kept for types that trim3r reads, and counted for others. */
typedef struct t3r_stream {
    t3r_text name;        /* the topic as the file holds it; points into its bytes */
    char *topic, *schema; /* printable copies */
    t3r_text schema_name;
    t3r_ros_type type; /* T3R_ROS_TYPE_COUNT = not read by trim3r */
    t3r_stream_role role;
    bool compressed;                   /* images are JPEG or PNG files */
    bool converted;                    /* images are in an encoding that only import converts */
    bool rectified;                    /* the topic's name says that its images have no distortion any more */
    bool mono;                         /* colour is grey, or depth is mono16, in which infrared images come */
    t3r_text frame_id, child_frame_id; /* of the first message that is kept, without a leading slash; point into the
                                          file's bytes */
    t3r_stream_use use;
    char unused[T3R_UNUSED_BYTES]; /* why it is not read */
    uint64_t count;
    uint64_t left_out;            /* messages, or transforms, that cannot be read */
    char fault[T3R_UNUSED_BYTES]; /* where the first of them is, and what is wrong with it */
    int64_t first_ns, last_ns;
    t3r_indexed_message *messages;
    size_t kept, capacity;
} t3r_stream;

/* Indices into the messages of the chosen streams; T3R_NO_MESSAGE = none. */
typedef struct t3r_frame_links {
    size_t depth, pose, camera_info, depth_camera_info;
} t3r_frame_links;

/* A pose set by t3r_recording_set_pose(). */
typedef struct t3r_set_pose {
    bool set;
    int64_t position_q32[3];
    int32_t rotation_q30[4];
} t3r_set_pose;

struct t3r_recording {
    t3r_recording_files files; /* none: it was parsed from memory */
    t3r_recording_bytes bytes;
    t3r_spill spill; /* holds large files, and chunks that do not fit in memory */
    t3r_mcap_chunks chunks;
    t3r_recording_cut cut; /* of the first file that is cut */

    t3r_stream *streams;
    size_t stream_count, stream_capacity;
    size_t colour, depth, pose, camera_info, depth_camera_info; /* the chosen streams, or T3R_NO_STREAM */
    size_t transforms;                                          /* the first stream of transforms */
    int64_t pair_ns;
    t3r_image_decoder decoder; /* decode NULL: none */

    t3r_frame_links *links; /* one per message of the colour stream */
    uint8_t **depth_z16;    /* one per message of the depth stream: its samples as Z16 from the first request on, if the
                               file holds another format */
    uint64_t *depth_beyond; /* samples of all images in depth_z16 that lie beyond 65535 steps */
    t3r_set_pose *set_poses; /* one per message of the colour stream; NULL until one is set */
    t3r_pairing_info pairing;

    uint32_t bits_epoch;
    bool intrinsics_given;
    t3r_camera intrinsics; /* of all frames, if given */
    uint64_t depth_unit_q40;
    bool states_unit; /* the file's metadata have the depth unit */
    char clock[64];
    t3r_triplet *triplets;
    uint32_t triplet_count;
    char note[T3R_NOTE_BYTES];
    char asks[T3R_ASKS_BYTES];                      /* the topics of which one must be named, or "" */
    const char *import_reason, *import_pose_reason; /* static texts; NULL: none */
};

void t3r_recording_remark(t3r_recording *recording, const char *format, ...) __attribute__((format(printf, 2, 3)));

/* Writes where a record is: "byte 12", in a recording of several files "byte 12 of bag_1.mcap". */
#define T3R_RECORDING_PLACE_BYTES 160
const char *t3r_recording_place_text(const t3r_recording *recording, uint32_t file, t3r_mcap_place place,
                                     char text[T3R_RECORDING_PLACE_BYTES]);
/* Returns the name of one of several files, else "". */
const char *t3r_recording_file_name(const t3r_recording *recording, uint32_t file);

/* recording_inspect.c: reads a message of a known type: its stamp, and from the first messages the role and frames of
 * their stream. Returns NULL, or what is wrong with the message. *usable: it may belong to a frame. *bad_transforms:
 * the transforms in it that cannot be used, the first of them for the reason *transform_error. */
typedef struct t3r_inspection {
    int64_t stamp_ns;
    bool usable;
    uint32_t bad_transforms;
    const char *transform_error;
} t3r_inspection;
const char *t3r_recording_inspect(t3r_recording *recording, t3r_stream *stream, const uint8_t *bytes, size_t count,
                                  t3r_inspection *out);

/* recording_names.c: what the words of a topic's name say. */
/* Whether it names images that are no camera's: overlays, masks, infrared, depth in colours. */
bool t3r_topic_is_no_colour(const char *topic);
/* Whether it names depth, and whether it names images in depth's encodings that hold no depth: infrared, confidence. */
bool t3r_topic_is_depth(const char *topic);
bool t3r_topic_is_no_depth(const char *topic);
/* Whether it names poses of something else than the camera: goals, commands, objects. */
bool t3r_topic_is_no_pose(const char *topic);

/* recording_choice.c: chooses the streams. Returns 0, or -1 with a reason if a named topic is missing. */
int t3r_recording_choose(t3r_recording *recording, const t3r_recording_choice *choice, char *error, size_t error_bytes);

/* recording_pairing.c: links each colour image to its companions. Returns 0, or -1 with a reason: memory is out, or
 * stamps go back or repeat, and log times do not rise. */
int t3r_recording_pair(t3r_recording *recording, char *error, size_t error_bytes);

#endif
