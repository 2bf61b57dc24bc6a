#include "import/poses/pose_matrix.h"

#include <math.h>
#include <stdbool.h>

#include "posing/quaternion.h"
#include "mcap/reader_limits.h"

const char *pose_of_matrix(const double m[16], camera_axes axes, double position[3], double rotation[4])
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
        position[i] = m[i * 4 + 3];
        if (!(fabs(position[i]) < 1 << T3R_LIMIT_POSITION_LOG2)) {
            return T3R_LIMIT_TEXT("a position is 2^", T3R_LIMIT_POSITION_LOG2, " or more");
        }
    }
    return quaternion_of(turned, rotation);
}
