/* SPDX-License-Identifier: Apache-2.0 */
#include "import/bags/bag_options.h"

#include "cli/options/option_values.h"
#include "import/frames/left_out.h"

enum {
    KEY_COLOUR = 0x1a0,
    KEY_DEPTH,
    KEY_POSE,
    KEY_CAMERA_INFO,
    KEY_DEPTH_CAMERA_INFO,
    KEY_FIXED_FRAME,
    KEY_CAMERA_FRAME,
    KEY_PAIR,
    KEY_STRICT
};

static const struct argp_option options[] = {
    {NULL, 0, NULL, 0, "What is read of a bag or a recording:", BAG_GROUP},
    {"colour-topic", KEY_COLOUR, "TOPIC", 0,
     "topic of the colour images (by type, name and intrinsics; of equally good ones one must be named)", BAG_GROUP},
    {"depth-topic", KEY_DEPTH, "TOPIC", 0,
     "topic of the depth images (the one nearest to the colour topic by name and frame, and none named after "
     "infrared, confidence or the like)",
     BAG_GROUP},
    {"pose-topic", KEY_POSE, "TOPIC", 0,
     "topic of the poses: PoseStamped, PoseWithCovarianceStamped, TransformStamped, Odometry, or /tf (the only one "
     "that is no goal or object, else /tf and /tf_static)",
     BAG_GROUP},
    {"camera-info-topic", KEY_CAMERA_INFO, "TOPIC", 0,
     "topic of colour's intrinsics (the one next to its images, of the same frame)", BAG_GROUP},
    {"depth-camera-info-topic", KEY_DEPTH_CAMERA_INFO, "TOPIC", 0,
     "topic of depth's intrinsics (the one next to its images, of the same frame)", BAG_GROUP},
    {"fixed-frame", KEY_FIXED_FRAME, "FRAME", 0,
     "fixed frame of the written poses (the poses' own, or the root above the camera)", BAG_GROUP},
    {"camera-frame", KEY_CAMERA_FRAME, "FRAME", 0, "frame of the colour camera (its images')", BAG_GROUP},
    {"pair", KEY_PAIR, "MS", 0,
     "milliseconds that depth, and a pose that is not between two others, may be from colour, 1..1000 (20)", BAG_GROUP},
    {"strict", KEY_STRICT, NULL, 0, LEFT_OUT_STRICT_HELP, 0},
    {0},
};

static error_t parse(int key, char *argument, struct argp_state *state)
{
    bag_options *o = state->input;
    const struct {
        int key;
        const char **value, *option;
    } names[] = {{KEY_COLOUR, &o->topics.colour, "--colour-topic"},
                 {KEY_DEPTH, &o->topics.depth, "--depth-topic"},
                 {KEY_POSE, &o->topics.pose, "--pose-topic"},
                 {KEY_CAMERA_INFO, &o->topics.camera_info, "--camera-info-topic"},
                 {KEY_DEPTH_CAMERA_INFO, &o->topics.depth_camera_info, "--depth-camera-info-topic"},
                 {KEY_FIXED_FRAME, &o->frames.fixed_frame, "--fixed-frame"},
                 {KEY_CAMERA_FRAME, &o->frames.camera_frame, "--camera-frame"}};
    for (size_t i = 0; i < sizeof names / sizeof names[0]; i++) {
        if (key == names[i].key) {
            *names[i].value = argument;
            o->given = names[i].option;
            return 0;
        }
    }
    if (key == ARGP_KEY_INIT) {
        o->frames.near_ns = INT64_C(20000000);
        return 0;
    }
    if (key == KEY_STRICT) {
        o->topics.strict = true;
        return 0;
    }
    if (key != KEY_PAIR) {
        return ARGP_ERR_UNKNOWN;
    }
    o->topics.pair_ns = o->frames.near_ns = option_number(state, "pair", argument, 1, 1000) * INT64_C(1000000);
    o->given = "--pair";
    return 0;
}

const struct argp bag_argp = {.options = options, .parser = parse};
