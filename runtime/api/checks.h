/* SPDX-License-Identifier: Apache-2.0 */
/* Checks of input from callers, files and copied arenas; deeper functions check nothing again. */
#ifndef T3R_CHECKS_H
#define T3R_CHECKS_H

#include <stdbool.h>

#include "core/fault.h"
#include "core/features.h"
#include "core/scene_frame.h"
#include "state/state.h"
#include "trim3r.h"

bool t3r_is_scene_frame(const t3r_scene_frame *frame);
bool t3r_is_gaussian(const t3r_gaussian *gaussian);

/* Whether every field is in the range that the configuration allows. */
bool t3r_is_build(const t3r_config *config, const t3r_build *build);

/* Whether the weights that this head needs are bound. */
bool t3r_has_head(const t3r_runtime *rt, t3r_head head);

#define T3R_NO_HEAD_TEXT "no head is bound: call t3r_bind_head() after t3r_init() and again after t3r_attach()"

T3R_CHECKS t3r_scene_frame_checks(const t3r_scene_frame *frame, t3r_fault *fault)
{
    const int64_t most = ((int64_t)1 << 62) - 1;
    for (int i = 0; i < 3; i++) {
        T3R_CHECK(fault, frame->origin_q32[i] >= -most && frame->origin_q32[i] <= most, T3R_ERR_ARGUMENT,
                  "frame.origin_q32[#] is #: a coordinate is -#..#, in 1/2^32 world unit", i, frame->origin_q32[i],
                  most, most);
    }
    T3R_CHECK(fault, frame->exponent >= T3R_EXPONENT_LEAST && frame->exponent <= T3R_EXPONENT_MOST, T3R_ERR_ARGUMENT,
              "frame.exponent is #: the exponent of a scene unit is #..#", frame->exponent, T3R_EXPONENT_LEAST,
              T3R_EXPONENT_MOST);
    return T3R_OK;
}

T3R_CHECKS t3r_gaussian_checks(const t3r_gaussian *g, t3r_fault *fault)
{
    for (int i = 0; i < 3; i++) {
        T3R_CHECK(fault, g->position_q20[i] >= -T3R_POSITION_MOST_Q20 && g->position_q20[i] <= T3R_POSITION_MOST_Q20,
                  T3R_ERR_ARGUMENT,
                  "gaussian.position_q20[#] is #: a coordinate is -#..#, in 1/2^20 scene unit (within 1,024)", i,
                  g->position_q20[i], T3R_POSITION_MOST_Q20, T3R_POSITION_MOST_Q20);
        T3R_CHECK(fault, g->colour_q7[i] <= 255 * 128, T3R_ERR_ARGUMENT,
                  "gaussian.colour_q7[#] is #: a colour is 0..#, in 1/128 level", i, g->colour_q7[i], 255 * 128);
        T3R_CHECK(fault, g->reserved[i] == 0, T3R_ERR_ARGUMENT, "gaussian.reserved[#] is #: it must be 0", i,
                  g->reserved[i]);
    }
    T3R_CHECK(fault, g->factor_exponent >= -60 && g->factor_exponent <= 15, T3R_ERR_ARGUMENT,
              "gaussian.factor_exponent is #: the exponent of F is -60..15", g->factor_exponent);
    T3R_CHECK(fault, g->opacity_q15 <= 32767, T3R_ERR_ARGUMENT,
              "gaussian.opacity_q15 is #: an opacity is 0..32767, in 1/2^15", g->opacity_q15);
    return T3R_OK;
}

T3R_CHECKS t3r_build_checks(const t3r_config *config, const t3r_build *build, t3r_fault *fault)
{
    T3R_CHECK(fault, build->gaussians >= 1 && build->gaussians <= config->max_gaussians, T3R_ERR_ARGUMENT,
              "request.gaussians is @: a budget is 1..#, which is config.max_gaussians, or 0 for the configuration's",
              build->gaussians, config->max_gaussians);
    T3R_CHECK(fault, build->allocate > T3R_ALLOCATE_CONFIGURED && build->allocate < T3R_ALLOCATE_COUNT,
              T3R_ERR_ARGUMENT, "request.allocate is @: a t3r_allocation is 0..#", build->allocate,
              T3R_ALLOCATE_COUNT - 1);
    T3R_CHECK(fault, build->refine <= config->refine, T3R_ERR_ARGUMENT, "refine is #: at most #", build->refine,
              config->refine);
    T3R_CHECK(fault,
              build->head > T3R_HEAD_CONFIGURED && build->head < T3R_HEAD_COUNT &&
                  t3r_has(t3r_feature_of_head(build->head)),
              T3R_ERR_ARGUMENT, "request.head is @: a t3r_head is 0..#", build->head, T3R_HEAD_COUNT - 1);
    return T3R_OK;
}

/* Checks that a checked camera is in the range of the scene's fixed point. */
T3R_CHECKS t3r_far_checks(const t3r_camera *camera, const t3r_scene_frame *frame, t3r_fault *fault)
{
    t3r_pose pose;
    T3R_CHECK(fault, t3r_pose_in_scene(camera, frame, &pose) == T3R_OK, T3R_ERR_CAMERA,
              "camera.position_q32 is # # #: more than 1,024 scene units, of 2^# world units, from the scene's origin",
              camera->position_q32[0], camera->position_q32[1], camera->position_q32[2], frame->exponent);
    return T3R_OK;
}

#endif
