/* SPDX-License-Identifier: Apache-2.0 */
/* The ROS 2 messages of a recording, read from and written to CDR. Doubles are kept as the file's 64 bits (names end
 * in _f64); recording_frame.c converts them to fixed point. */
#ifndef T3R_PLATFORM_ROS_MESSAGES_H
#define T3R_PLATFORM_ROS_MESSAGES_H

#include <stdbool.h>
#include <stdint.h>

#include "cdr.h"
#include "host/text.h"

#define T3R_ROS_MAX_D 16u /* no model in use has more than 14 distortion coefficients */

/* Messages that trim3r reads; it writes IMAGE, CAMERA_INFO, POSE and TF. */
typedef enum t3r_ros_type {
    T3R_ROS_IMAGE,
    T3R_ROS_CAMERA_INFO,
    T3R_ROS_POSE,
    T3R_ROS_TRANSFORM,
    T3R_ROS_TF,
    T3R_ROS_ODOMETRY,
    T3R_ROS_POSE_COVARIANCE,
    T3R_ROS_COMPRESSED_IMAGE,
    T3R_ROS_TYPE_COUNT
} t3r_ros_type;

/* "sensor_msgs/msg/Image" ... */
extern const char *const t3r_ros_names[T3R_ROS_TYPE_COUNT];
/* Whether a schema name is that message's: "package/msg/Type", or "package/Type" from older writers. */
bool t3r_ros_is_named(t3r_ros_type type, t3r_text name);
/* Definitions of the messages that trim3r writes, with all referenced types, in MCAP's schema encoding "ros2msg". */
extern const char *const t3r_ros_schemas[T3R_ROS_TYPE_COUNT];

/* Only the recorder writes these: lines of text. */
extern const char *const t3r_ros_log_name;
extern const char *const t3r_ros_log_schema;

typedef struct t3r_ros_header {
    int64_t stamp_ns; /* seconds in int32_t, so |stamp_ns| < 2^62 */
    t3r_text frame_id;
} t3r_ros_header;

typedef struct t3r_ros_image {
    t3r_ros_header header;
    uint32_t height, width;
    t3r_text encoding;
    bool is_bigendian;
    uint32_t step; /* bytes between the starts of rows */
    const uint8_t *data;
    uint32_t data_bytes;
} t3r_ros_image;

/* sensor_msgs/msg/CompressedImage: a JPEG or PNG file; if format says compressedDepth, after a header of its own. */
typedef struct t3r_ros_compressed {
    t3r_ros_header header;
    t3r_text format;
    const uint8_t *data;
    uint32_t data_bytes;
} t3r_ros_compressed;

typedef struct t3r_ros_camera_info {
    t3r_ros_header header;
    uint32_t height, width;
    t3r_text distortion_model;
    uint32_t d_count;
    uint64_t d_f64[T3R_ROS_MAX_D];
    uint64_t k_f64[9], r_f64[9], p_f64[12]; /* row-major */
    uint32_t binning_x, binning_y;
    uint32_t roi_x, roi_y, roi_height, roi_width;
    bool roi_rectify;
} t3r_ros_camera_info;

/* The common fields of all pose messages: from the child's frame to header.frame_id. */
typedef struct t3r_ros_pose {
    t3r_ros_header header;
    t3r_text child_frame_id; /* for TransformStamped and Odometry, else empty */
    uint64_t position_f64[3];
    uint64_t rotation_f64[4]; /* x y z w */
} t3r_ros_pose;

/* Return NULL, or which field is malformed or cut short. Texts and data point into the message. */
const char *t3r_ros_read_image(const uint8_t *bytes, size_t count, t3r_ros_image *image);
/* Reads the first bytes of an image message: everything except its data, which is NULL and begins at *data_at. */
const char *t3r_ros_read_image_head(const uint8_t *bytes, size_t count, t3r_ros_image *image, size_t *data_at);
const char *t3r_ros_read_camera_info(const uint8_t *bytes, size_t count, t3r_ros_camera_info *info);
const char *t3r_ros_read_compressed(const uint8_t *bytes, size_t count, t3r_ros_compressed *image);
/* Reads PoseStamped, TransformStamped, Odometry and PoseWithCovarianceStamped, for which t3r_ros_is_pose() holds. */
const char *t3r_ros_read_pose(t3r_ros_type type, const uint8_t *bytes, size_t count, t3r_ros_pose *pose);
bool t3r_ros_is_pose(t3r_ros_type type);

/* The transforms of a TFMessage in order: open, then next while `left`. */
typedef struct t3r_ros_tf {
    t3r_cdr_reader in;
    uint32_t left;
} t3r_ros_tf;
const char *t3r_ros_open_tf(const uint8_t *bytes, size_t count, t3r_ros_tf *tf);
const char *t3r_ros_next_tf(t3r_ros_tf *tf, t3r_ros_pose *transform);

/* rcl_interfaces/msg/Log without file, function and line. */
typedef struct t3r_ros_log {
    int64_t stamp_ns;
    uint8_t level; /* 10 debug, 20 info, 30 warning, 40 error */
    t3r_text name, message;
} t3r_ros_log;

/* Write messages, whose stamp must lie in 0 .. 2^31 seconds. An image is written up to the count of its data; the
 * caller adds the data_bytes bytes by t3r_cdr_put_raw(). */
void t3r_ros_write_image_head(t3r_cdr_writer *out, const t3r_ros_image *image);
void t3r_ros_write_camera_info(t3r_cdr_writer *out, const t3r_ros_camera_info *info);
void t3r_ros_write_pose(t3r_cdr_writer *out, const t3r_ros_pose *pose);
/* Writes a tf2_msgs/msg/TFMessage of this one transform, child to frame. */
void t3r_ros_write_tf(t3r_cdr_writer *out, const t3r_ros_pose *pose);
void t3r_ros_write_log(t3r_cdr_writer *out, const t3r_ros_log *log);

#endif
