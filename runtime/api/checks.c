/* SPDX-License-Identifier: Apache-2.0 */
#include "api/checks.h"

bool t3r_is_scene_frame(const t3r_scene_frame *frame)
{
    return t3r_scene_frame_checks(frame, NULL) == T3R_OK;
}

bool t3r_is_gaussian(const t3r_gaussian *gaussian)
{
    return t3r_gaussian_checks(gaussian, NULL) == T3R_OK;
}

bool t3r_is_build(const t3r_config *config, const t3r_build *build)
{
    return t3r_build_checks(config, build, NULL) == T3R_OK;
}

bool t3r_has_head(const t3r_runtime *rt, t3r_head head)
{
    return !T3R_FEATURE_LEARNED || head != T3R_HEAD_LEARNED || rt->weights != NULL;
}
