/* SPDX-License-Identifier: Apache-2.0 */
/* t3r_attach() of small arenas with a valid configuration and arbitrary other bytes. */
#include "layout/arena.h"
#include "state/state.h"

#include "core/camera.h"
#include "core/scene_frame.h"

/* pose.c proves this contract for these arguments. */
/*@ requires x: -T3R_MAX_POSITION_Q32 < camera->position_q32[0] < T3R_MAX_POSITION_Q32;
    requires y: -T3R_MAX_POSITION_Q32 < camera->position_q32[1] < T3R_MAX_POSITION_Q32;
    requires z: -T3R_MAX_POSITION_Q32 < camera->position_q32[2] < T3R_MAX_POSITION_Q32;
    requires left: -4611686018427387904 < frame->origin_q32[0] < 4611686018427387904;
    requires top: -4611686018427387904 < frame->origin_q32[1] < 4611686018427387904;
    requires front: -4611686018427387904 < frame->origin_q32[2] < 4611686018427387904;
    requires exponent: T3R_EXPONENT_LEAST <= frame->exponent <= T3R_EXPONENT_MOST;
    assigns *pose, \result \from *camera, *frame;
    ensures \result == T3R_OK || \result == T3R_ERR_CAMERA; */
t3r_status t3r_pose_in_scene(const t3r_camera *camera, const t3r_scene_frame *frame, t3r_pose *pose);

enum { ROOM = 1 << 18, SIDE = 8, VIEWS = 2, BUDGET = 16, CLUSTERS = 3 };

static uint8_t arena[ROOM];

/* The memory ends with the array: a step past its end is out of bounds. */
static void attach(const t3r_config *config)
{
    t3r_layout layout;
    (void)t3r_lay_out(config, 0, &layout);
    uint8_t *bytes = arena + ROOM - layout.min_bytes;
    t3r_any_bytes(bytes, layout.min_bytes);
    t3r_runtime *rt = (t3r_runtime *)(void *)bytes, *attached;
    rt->magic = T3R_MAGIC;
    rt->bits_epoch = T3R_BITS_EPOCH;
    rt->arena_bytes = layout.min_bytes;
    rt->config = *config;
    t3r_attach(&attached, bytes, layout.min_bytes);
}

int main(void)
{
    t3r_config config = t3r_default_config(SIDE, SIDE, VIEWS, BUDGET);
    config.clusters = CLUSTERS;
    config.cluster_batches = 1;
    attach(&config);
    config.warm = 1;
    attach(&config);
    config.warm = 0;
    config.depth = T3R_DEPTH_STEREO;
    attach(&config);
    config.depth = T3R_DEPTH_SENSOR;
    config.stream = 1;
    attach(&config);
    return 0;
}
