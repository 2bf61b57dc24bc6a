/* What is made of a bag's frames beyond reading them: poses composed and interpolated, depth registered to colour. */
#ifndef TRIM3R_TOOLS_BAG_FRAMES_H
#define TRIM3R_TOOLS_BAG_FRAMES_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "import/depth/register_depth.h"
#include "import/bags/transform_tree.h"
#include "recording/recording.h"

typedef struct bag_frames_options {
    const char *fixed_frame;  /* of the poses; NULL: that of the pose topic, or the root above the camera */
    const char *camera_frame; /* NULL: that of the colour images */
    bool keep_poses;          /* frames keep those that they come with */
    int64_t near_ns;          /* outside of what a track covers, its ends hold for so long */
} bag_frames_options;

typedef struct bag_frames {
    const t3r_recording *recording;
    bag_frames_options options;
    transform_tree tree;
    pose_track poses; /* of the pose topic */
    t3r_text camera, fixed, pose_parent, pose_child;
    uint8_t *depth; /* registered, of the last frame that had other depth, camera or place than the one before */
    ray_grid rays;
    const uint8_t *depth_of[3]; /* its messages: depth and the two camera_info */
    rigid depth_place;
    /* counted as frames are made */
    uint32_t interpolated, composed, unposed, registered, unregistered;
    char remark[256]; /* the first reason why a frame has no pose, or its depth is left out; "" */
} bag_frames;

/* Reads transforms and poses. 0, or -1 with a reason; bag_frames_close() in either case. The recording outlives it. */
int bag_frames_open(bag_frames *b, const t3r_recording *recording, const bag_frames_options *options, char *error,
                    size_t error_bytes);
/* Changes what t3r_recording_frame() gave for frame `index`: its pose and its depth, which stay valid until the next
 * call. A pose that the recording holds for that very time, in the frames asked for, stays as it is. 0, or -1 with a
 * reason. */
int bag_frames_make(bag_frames *b, uint32_t index, t3r_capture_frame *frame, char *error, size_t error_bytes);
void bag_frames_close(bag_frames *b);

#endif
