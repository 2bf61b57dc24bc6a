/* SPDX-License-Identifier: Apache-2.0 */
/* Turns messages of a camera's topics, in the order of arrival, into frames for the map: checked, paired by time, in
 * bounded queues. It depends on no version of ROS.
 *
 * Times now_ns are of any steady clock of the caller's. Stamps are the messages' own. */
#ifndef TRIM3R_TOOLS_FRAME_FEED_H
#define TRIM3R_TOOLS_FRAME_FEED_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

#include "messages/ros_messages.h"
#include "trim3r.h"

#define FRAME_FEED_NAME_BYTES 128 /* of a frame id, with its end */
#define FRAME_FEED_REASON_BYTES 320

typedef enum frame_feed_topic {
    FRAME_FEED_COLOUR,
    FRAME_FEED_DEPTH,
    FRAME_FEED_CAMERA_INFO,
    FRAME_FEED_POSE,
    FRAME_FEED_TOPICS
} frame_feed_topic;

typedef enum frame_feed_found { FRAME_FEED_NEVER = -1, FRAME_FEED_NOT_YET, FRAME_FEED_FOUND } frame_feed_found;

typedef struct frame_feed_settings {
    uint32_t queue;          /* most waiting images of either kind, 2..32 [8] */
    int64_t pair_ns;         /* largest gap within one instant [20 ms] */
    int64_t patience_ns;     /* longest wait of a colour image for its depth, and of a pair for its pose and the first
                                intrinsics [500 ms] */
    uint64_t depth_unit_q40; /* of 16-bit depth in metres, above 0 [0.001] */
    const char *world;       /* the frame of poses; copied. "" = the first pose's [""] */

    void *user; /* for the calls below */
    /* Receives a frame with colour, depth, intrinsics and pose; valid during the call, as is the world's name. */
    void (*frame)(void *user, int64_t stamp_ns, const char *world, const t3r_frame *frame, const t3r_camera *camera,
                  int64_t now_ns);
    /* Receives the reason why a message of the topic is not used. At most one line per topic and reason in five
     * seconds, with the number of suppressed ones. */
    void (*warn)(void *user, frame_feed_topic topic, const char *reason);
    /* Releases the owner of an image that is no longer needed. */
    void (*release)(void *user, void *owner);
    /* Finds the pose of the camera's frame at that time elsewhere; *pose then has the world's name. NULL = poses come
     * by frame_feed_pose(). */
    frame_feed_found (*locate)(void *user, int64_t stamp_ns, const char *camera, t3r_ros_pose *pose);
} frame_feed_settings;

frame_feed_settings frame_feed_defaults(void);

typedef struct frame_feed frame_feed;

/* Returns NULL with the reason in error[] on failure. */
frame_feed *frame_feed_open(const frame_feed_settings *settings, char *error, size_t error_bytes);
void frame_feed_close(frame_feed *feed);

/* Notes the full name of the topic of colour: if it names rectified images, their lens is P without distortion. */
void frame_feed_colour_topic(frame_feed *feed, const char *name);
/* Adds an image of FRAME_FEED_COLOUR or FRAME_FEED_DEPTH. `owner` keeps its bytes until it is released, immediately if
 * the image is refused. Compressed images are decoded during the call and released. */
void frame_feed_image(frame_feed *feed, frame_feed_topic topic, const t3r_ros_image *image, void *owner,
                      int64_t now_ns);
void frame_feed_compressed(frame_feed *feed, frame_feed_topic topic, const t3r_ros_compressed *image, void *owner,
                           int64_t now_ns);
void frame_feed_camera_info(frame_feed *feed, const t3r_ros_camera_info *info, int64_t now_ns);
/* Adds the pose of the camera's optical frame in header.frame_id, which is the world. One that is none
 * (t3r_message_pose_error()) is left out with a warning. */
void frame_feed_pose(frame_feed *feed, const t3r_ros_pose *pose, int64_t now_ns);
/* Whether a transform is one (t3r_message_transform_error()); if not, it is left out like such a pose. */
bool frame_feed_transform(frame_feed *feed, const t3r_ros_pose *transform, int64_t now_ns);
/* Issues a warning of the caller's, throttled like the feed's own. */
void frame_feed_warn(frame_feed *feed, frame_feed_topic topic, const char *reason, int64_t now_ns);
/* Notes that time has passed, or that `locate` may find more. To be called regularly. */
void frame_feed_tick(frame_feed *feed, int64_t now_ns);

typedef struct frame_feed_counts {
    uint64_t images, frames, refused; /* colour images; refused: without depth, intrinsics or pose, or malformed */
    uint64_t poses_left_out;          /* also transforms: not numbers, or rotations without direction */
} frame_feed_counts;
frame_feed_counts frame_feed_counts_of(const frame_feed *feed);

#ifdef __cplusplus
}
#endif
#endif
