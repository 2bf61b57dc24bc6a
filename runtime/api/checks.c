/* SPDX-License-Identifier: Apache-2.0 */
#include "api/checks.h"

#include "core/features.h"
#include "core/scene_frame.h"

bool t3r_is_scene_frame(const t3r_scene_frame *frame)
{
    const int64_t most = (int64_t)1 << 62;
    for (int i = 0; i < 3; i++) {
        if (frame->origin_q32[i] <= -most || frame->origin_q32[i] >= most) {
            return false;
        }
    }
    return frame->exponent >= T3R_EXPONENT_LEAST && frame->exponent <= T3R_EXPONENT_MOST;
}

bool t3r_is_gaussian(const t3r_gaussian *g)
{
    for (int i = 0; i < 3; i++) {
        if (g->position_q20[i] < -T3R_POSITION_MOST_Q20 || g->position_q20[i] > T3R_POSITION_MOST_Q20 ||
            g->colour_q7[i] > 255 * 128 || g->reserved[i] != 0) {
            return false;
        }
    }
    return g->factor_exponent >= -60 && g->factor_exponent <= 15 && g->opacity_q15 <= 32767;
}

bool t3r_is_build(const t3r_config *config, const t3r_build *build)
{
    return build->gaussians >= 1 && build->gaussians <= config->max_gaussians &&
           (uint32_t)build->allocate > T3R_ALLOCATE_CONFIGURED && (uint32_t)build->allocate < T3R_ALLOCATE_COUNT &&
           build->refine <= config->refine && (uint32_t)build->head > T3R_HEAD_CONFIGURED &&
           (uint32_t)build->head < T3R_HEAD_COUNT && t3r_has(t3r_feature_of_head(build->head));
}

bool t3r_has_head(const t3r_runtime *rt, t3r_head head)
{
    return head != T3R_HEAD_LEARNED || rt->weights != NULL;
}
