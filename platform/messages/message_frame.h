/* ROS 2 messages of one instant as a frame and its camera: checked, and their doubles turned into fixed point. No heap:
 * a frame's planes lie in the messages' own bytes. Each check returns NULL, or what is wrong. */
#ifndef T3R_PLATFORM_MESSAGE_FRAME_H
#define T3R_PLATFORM_MESSAGE_FRAME_H

#include "ros_messages.h"
#include "trim3r.h"

/* Whether the image has an encoding of depth: 16UC1, mono16, 32FC1. */
bool t3r_message_is_depth(const t3r_ros_image *image);

/* Format, size and strides of the colour planes of a frame; the image needs no data. */
const char *t3r_message_colour_shape(const t3r_ros_image *image, t3r_frame *frame);
/* The planes, too. */
const char *t3r_message_colour(const t3r_ros_image *image, t3r_frame *frame);
/* Of an image of depth: whether its samples are metres, and whether they are little-endian steps as they stand. */
bool t3r_message_is_metres(const t3r_ros_image *image);
bool t3r_message_is_z16(const t3r_ros_image *image);
/* The depth plane, but for its unit. frame->depth is NULL where the samples are no little-endian steps: of
 * t3r_message_to_z16(), then, with rows of depth_stride_bytes. */
const char *t3r_message_depth(const t3r_ros_image *image, t3r_frame *frame);
/* The samples of such an image as steps of the unit, width x height x 2 bytes; `out` may be where they begin. */
void t3r_message_to_z16(const t3r_ros_image *image, uint64_t unit_q40, uint8_t *out);

/* Focal lengths, centre and distortion; the size in `info` is the caller's to compare. */
const char *t3r_message_intrinsics(const t3r_ros_camera_info *info, t3r_camera *camera);
/* Position and rotation. */
const char *t3r_message_pose(const t3r_ros_pose *pose, t3r_camera *camera);

#endif
