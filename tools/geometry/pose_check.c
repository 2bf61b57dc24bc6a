/* SPDX-License-Identifier: Apache-2.0 */
#include "geometry/pose_check.h"

#include <math.h>

#include "geometry/quaternion.h"
#include "mcap/reader_limits.h"

const char *pose_check_position(const double position[3])
{
    for (int i = 0; i < 3; i++) {
        if (!isfinite(position[i])) {
            return "a number is not finite";
        }
        if (!(fabs(position[i]) < 1 << T3R_LIMIT_POSITION_LOG2)) {
            return T3R_LIMIT_TEXT("a position is 2^", T3R_LIMIT_POSITION_LOG2, " or more");
        }
    }
    return NULL;
}

const char *pose_check(const rigid *pose)
{
    const char *wrong = pose_check_position(pose->position);
    const double norm = quaternion_norm(pose->rotation);
    /* negated so that NaN is refused too */
    return wrong == NULL && !(norm >= 0.9 && norm <= 1.1) ? "the quaternion's norm is not 1 within 0.1" : wrong;
}
