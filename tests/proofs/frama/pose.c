/* SPDX-License-Identifier: Apache-2.0 */
/* t3r_pose_in_scene() for all arguments that t3r_attach() accepts, one exponent at a time, because it decides a shift.
 */
#include "core/camera.h"
#include "core/scene_frame.h"

/* The quaternion's norm bounds the rotation's sums, which Eva does not track. */
/*@ assigns rotation_q30[0 .. 8] \from quaternion_q30[0 .. 3];
    ensures \initialized(rotation_q30 + (0 .. 8)); */
void t3r_camera_rotation(const int32_t quaternion_q30[4], int32_t rotation_q30[9]);

int main(void)
{
    const int64_t most = T3R_MAX_POSITION_Q32 - 1;
    t3r_camera camera = {.rotation_q30 = {1 << 30}};
    t3r_scene_frame frame;
    t3r_pose pose;
    for (int i = 0; i < 3; i++) {
        camera.position_q32[i] = t3r_any(-most, most);
        frame.origin_q32[i] = t3r_any(-most, most);
    }
    for (int32_t exponent = T3R_EXPONENT_LEAST; exponent <= T3R_EXPONENT_MOST; exponent++) {
        frame.exponent = exponent;
        t3r_pose_in_scene(&camera, &frame, &pose);
    }
    return 0;
}
