/* SPDX-License-Identifier: Apache-2.0 */
/* Converts ROS 2 messages of one instant to a frame and its camera: checks them and converts doubles to fixed point.
 * No heap: a frame's planes lie in the messages' own bytes. Each check returns NULL, or what is wrong. */
#ifndef T3R_PLATFORM_MESSAGE_FRAME_H
#define T3R_PLATFORM_MESSAGE_FRAME_H

#include "ros_messages.h"
#include "trim3r.h"

/* Whether the image has an encoding of depth: 16UC1, mono16, 32FC1. */
bool t3r_message_is_depth(const t3r_ros_image *image);

/* Checks and fills in format, size and strides of a frame's colour planes; the image needs no data. */
const char *t3r_message_colour_shape(const t3r_ros_image *image, t3r_frame *frame);
/* Does the same, and fills in the planes. */
const char *t3r_message_colour(const t3r_ros_image *image, t3r_frame *frame);
/* Whether the samples of a depth image are metres; whether they are little-endian steps that need no conversion. */
bool t3r_message_is_metres(const t3r_ros_image *image);
bool t3r_message_is_z16(const t3r_ros_image *image);
/* Fills in the depth plane, without its unit. frame->depth is NULL if the samples need conversion: use
 * t3r_message_to_z16() then, with rows of depth_stride_bytes. */
const char *t3r_message_depth(const t3r_ros_image *image, t3r_frame *frame);
/* Whether depth has another aspect than colour, by more than a pixel: it cannot show the same view. */
bool t3r_message_is_stretched(const t3r_frame *frame);
/* Converts the samples of such an image to steps of the unit, width x height x 2 bytes; `out` may be the start of the
 * samples. Returns how many lie beyond 65535 steps, which become 0. */
uint32_t t3r_message_to_z16(const t3r_ros_image *image, uint64_t unit_q40, uint8_t *out);

/* Fills in focal lengths, centre and distortion; the caller must compare the size in `info`. */
const char *t3r_message_intrinsics(const t3r_ros_camera_info *info, t3r_camera *camera);
/* Whether only the range or the number of the coefficients of a lens in radial-tangential or rational form refuses it:
 * import redraws the images of such a lens. */
bool t3r_message_is_bent(const t3r_ros_camera_info *info);
/* Replaces K and D by what holds for rectified images: the left part of P, and no distortion. */
const char *t3r_message_rectify(t3r_ros_camera_info *info);
/* Checks that a pose is one: a position of numbers and a rotation with a direction. Drivers send others while they do
 * not know the pose. */
const char *t3r_message_pose_error(const t3r_ros_pose *pose);
/* Checks the same of a transform, and that its two frames have names, and different ones. */
const char *t3r_message_transform_error(const t3r_ros_pose *transform);
/* Fills in position and rotation, whose norm is brought into the range of t3r_camera by a power of two. */
const char *t3r_message_pose(const t3r_ros_pose *pose, t3r_camera *camera);

#endif
