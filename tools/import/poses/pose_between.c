#include "import/poses/pose_between.h"

#include <math.h>
#include <string.h>

void pose_between(const double a[POSE_NUMBERS], const double b[POSE_NUMBERS], double t, double out[POSE_NUMBERS])
{
    double dot = a[3] * b[3] + a[4] * b[4] + a[5] * b[5] + a[6] * b[6];
    for (int i = 0; i < POSE_NUMBERS; i++) {
        double end = i >= 3 && dot < 0 ? -b[i] : b[i];
        out[i] = a[i] + t * (end - a[i]);
    }
}

void pose_split(const double pose[POSE_NUMBERS], double position[3], double rotation[4])
{
    double norm = sqrt(pose[3] * pose[3] + pose[4] * pose[4] + pose[5] * pose[5] + pose[6] * pose[6]);
    memcpy(position, pose, 3 * sizeof *position);
    rotation[0] = pose[6] / norm;
    for (int i = 0; i < 3; i++) {
        rotation[1 + i] = pose[3 + i] / norm;
    }
}
