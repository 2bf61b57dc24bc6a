/* SPDX-License-Identifier: Apache-2.0 */
#include "scene_frame.h"

#include "camera.h"
#include "fixed.h"

t3r_status t3r_pose_in_scene(const t3r_camera *camera, const t3r_scene_frame *frame, t3r_pose *pose)
{
    t3r_camera_rotation(camera->rotation_q30, pose->rotation_q30);
    for (int i = 0; i < 3; i++) {
        /* both are below 2^62 (t3r_camera_check), so the difference is exact; scaling is by 2^-36..2^12 */
        int64_t offset = camera->position_q32[i] - frame->origin_q32[i];
        if (t3r_abs64(offset) >= (int64_t)1 << 61) {
            return T3R_ERR_CAMERA;
        }
        int32_t shift = -12 - frame->exponent;
        if (shift > 0 && t3r_abs64(offset) > T3R_POSITION_MOST_Q20) {
            return T3R_ERR_CAMERA;
        }
        offset = t3r_scale64(offset, shift);
        if (t3r_abs64(offset) > T3R_POSITION_MOST_Q20) {
            return T3R_ERR_CAMERA;
        }
        pose->position_q20[i] = (int32_t)offset;
    }
    return T3R_OK;
}

t3r_depth_scale t3r_depth_scale_of(uint64_t depth_unit_q40, int32_t exponent)
{
    int32_t msb = (int32_t)t3r_msb64(depth_unit_q40);
    uint32_t mantissa = (uint32_t)(msb >= 31 ? depth_unit_q40 >> (msb - 31) : depth_unit_q40 << (31 - msb));
    /* unit = mantissa 2^(msb - 31) in Q40; in Q20 scene units 2^(-20 - exponent) of that. A left shift would clamp
     * every product but 0 anyway, and a right shift of 62 or more rounds all to 0. */
    return (t3r_depth_scale){mantissa, (uint32_t)t3r_clamp32(20 + exponent - (msb - 31), 0, 62)};
}
