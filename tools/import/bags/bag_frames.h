/* SPDX-License-Identifier: Apache-2.0 */
/* Import's changes to a bag's frames: composes and interpolates poses, registers depth to colour. */
#ifndef TRIM3R_TOOLS_BAG_FRAMES_H
#define TRIM3R_TOOLS_BAG_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "import/bags/transform_tree.h"
#include "import/depth/register_depth.h"
#include "pictures/picture.h"
#include "recording/recording.h"

typedef struct bag_frames_options {
    const char *fixed_frame;  /* parent frame of the poses; NULL: the pose topic's, or the root above the camera */
    const char *camera_frame; /* NULL: the colour images' frame */
    bool keep_poses;          /* keep the poses that frames come with */
    int64_t near_ns;          /* the first and the last pose of a track are used this long outside it */
} bag_frames_options;

typedef struct bag_frames {
    const t3r_recording *recording;
    bag_frames_options options;
    transform_tree tree;
    pose_track poses; /* from the pose topic */
    t3r_text camera, fixed, pose_parent, pose_child;
    uint8_t *depth; /* registered depth of the last frame whose depth, camera or place changed */
    ray_grid rays;
    const uint8_t *depth_of[3]; /* its source messages: depth and the two camera_info */
    rigid depth_place;
    picture straight; /* depth with its own lens, redrawn like colour */
    /* counts over the frames made so far */
    uint32_t interpolated, composed, unposed, registered, unregistered, straightened;
    char remark[256]; /* the first reason why a frame has no pose or no depth; "" */
} bag_frames;

/* Reads transforms and poses. Returns 0, or -1 with a reason; call bag_frames_close() in either case. The recording
 * must outlive `b`. */
int bag_frames_open(bag_frames *b, const t3r_recording *recording, const bag_frames_options *options, char *error,
                    size_t error_bytes);
/* Changes the pose and depth that t3r_recording_frame() gave frame `index`; they stay valid until the next call. A pose
 * that the recording holds for exactly that time, in the requested frames, is kept. Returns 0, or -1 with a reason. */
int bag_frames_make(bag_frames *b, uint32_t index, t3r_capture_frame *frame, char *error, size_t error_bytes);
/* Sets the counts and the remark back, before frames are made a second time. */
void bag_frames_count_anew(bag_frames *b);
void bag_frames_close(bag_frames *b);

#endif
