/* SPDX-License-Identifier: Apache-2.0 */
/* Measures the difference of two rigid transforms. */
#ifndef TRIM3R_TESTS_RIGID_ERRORS_H
#define TRIM3R_TESTS_RIGID_ERRORS_H

#include <math.h>

#include "geometry/quaternion.h"
#include "geometry/rigid.h"

static inline double length_of(const double v[3])
{
    return sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
}

/* Returns the radians between two directions. */
static inline double radians_between(const double a[3], const double b[3])
{
    const double cross[3] = {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
    return atan2(length_of(cross), a[0] * b[0] + a[1] * b[1] + a[2] * b[2]);
}

/* Returns the radians between two rotations. */
static inline double radians_turned(const rigid *a, const rigid *b)
{
    double back[4], turn[4];
    quaternion_conjugate(a->rotation, back);
    quaternion_multiply(back, b->rotation, turn);
    return 2 * atan2(length_of(turn + 1), fabs(turn[0]));
}

/* Rotates by |v| radians about v, which is not 0. */
static inline rigid rotation_about(const double v[3])
{
    const double angle = length_of(v), s = sin(angle / 2) / angle;
    return (rigid){{0, 0, 0}, {cos(angle / 2), s * v[0], s * v[1], s * v[2]}};
}

#endif
