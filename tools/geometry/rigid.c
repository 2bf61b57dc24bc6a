/* SPDX-License-Identifier: Apache-2.0 */
#include "geometry/rigid.h"

#include <math.h>

#include "geometry/quaternion.h"

/* Nearly parallel quaternions are joined by a line: the sine of the angle between them says too little. */
#define PARALLEL 0.9999995

const rigid rigid_identity = {{0, 0, 0}, {1, 0, 0, 0}};

void rigid_apply(const rigid *transform, const double point[3], double out[3])
{
    quaternion_rotate(transform->rotation, point, out);
    for (int i = 0; i < 3; i++) {
        out[i] += transform->position[i];
    }
}

rigid rigid_compose(const rigid *outer, const rigid *inner)
{
    rigid out;
    quaternion_multiply(outer->rotation, inner->rotation, out.rotation);
    quaternion_normalise(out.rotation);
    rigid_apply(outer, inner->position, out.position);
    return out;
}

rigid rigid_inverse(const rigid *transform)
{
    const double *p = transform->position, back[3] = {-p[0], -p[1], -p[2]};
    rigid out;
    quaternion_conjugate(transform->rotation, out.rotation);
    quaternion_rotate(out.rotation, back, out.position);
    return out;
}

rigid rigid_between(const rigid *a, const rigid *b, double t)
{
    double dot = 0, from = 1 - t, to = t;
    for (int i = 0; i < 4; i++) {
        dot += a->rotation[i] * b->rotation[i];
    }
    double sign = dot < 0 ? -1 : 1;
    dot = fabs(dot);
    if (dot < PARALLEL) {
        double angle = acos(dot);
        from = sin((1 - t) * angle) / sin(angle);
        to = sin(t * angle) / sin(angle);
    }
    rigid out;
    for (int i = 0; i < 3; i++) {
        out.position[i] = (1 - t) * a->position[i] + t * b->position[i];
    }
    for (int i = 0; i < 4; i++) {
        out.rotation[i] = from * a->rotation[i] + sign * to * b->rotation[i];
    }
    quaternion_normalise(out.rotation);
    return out;
}
