/* SPDX-License-Identifier: Apache-2.0 */
#include "import/poses/pose_matrix.h"

#include <math.h>
#include <stddef.h>

#include "geometry/quaternion.h"
#include "import/poses/pose_check.h"

const char *pose_of_matrix(const double m[16], camera_axes axes, rigid *pose)
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
    const double sign = axes == AXES_OPENGL ? -1 : 1; /* of the columns y and z */
    for (int i = 0; i < 3; i++) {
        turned[i * 3] = m[i * 4];
        turned[i * 3 + 1] = sign * m[i * 4 + 1];
        turned[i * 3 + 2] = sign * m[i * 4 + 2];
        pose->position[i] = m[i * 4 + 3];
    }
    const char *wrong = pose_check_position(pose->position);
    return wrong != NULL ? wrong : quaternion_of(turned, pose->rotation);
}
