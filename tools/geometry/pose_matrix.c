/* SPDX-License-Identifier: Apache-2.0 */
#include "geometry/pose_matrix.h"

#include <math.h>
#include <stddef.h>

#include "geometry/pose_check.h"
#include "geometry/quaternion.h"

const char *pose_of_matrix(const double m[16], t3r_axes axes, rigid *pose)
{
    static const double last[4] = {0, 0, 0, 1};
    double turned[9];
    for (int i = 0; i < 16; i++) {
        if (!isfinite(m[i])) {
            return "an entry is not a finite number";
        }
    }
    for (int i = 0; i < 4; i++) {
        if (fabs(m[12 + i] - last[i]) > 1e-6) {
            return "the last row is not 0 0 0 1";
        }
    }
    const double sign = axes == T3R_AXES_OPENGL ? -1 : 1; /* of the columns y and z */
    for (int i = 0; i < 3; i++) {
        turned[i * 3] = m[i * 4];
        turned[i * 3 + 1] = sign * m[i * 4 + 1];
        turned[i * 3 + 2] = sign * m[i * 4 + 2];
        pose->position[i] = m[i * 4 + 3];
    }
    const char *wrong = pose_check_position(pose->position);
    return wrong != NULL ? wrong : quaternion_of(turned, pose->rotation);
}

rigid pose_of_convention(const rigid *pose, uint32_t axes)
{
    static const double half_turn[4] = {0, 1, 0, 0}; /* about x: from the axes of OpenGL to those of OpenCV */
    rigid out = (axes & T3R_WORLD_TO_CAMERA) != 0 ? rigid_inverse(pose) : *pose;
    if ((axes & T3R_AXES_OPENGL) != 0) {
        const rigid given = out;
        quaternion_multiply(given.rotation, half_turn, out.rotation);
    }
    return out;
}
