#include "import/poses/rigid.h"

#include <math.h>

/* Above this cosine quaternions are interpolated linearly, because the sine of the angle between them is too
 * inexact. */
#define PARALLEL 0.9999995

const rigid rigid_identity = {{0, 0, 0}, {1, 0, 0, 0}};

static void rotate(const double q[4], const double v[3], double out[3])
{
    const double u[3] = {q[1], q[2], q[3]};
    const double t[3] = {2 * (u[1] * v[2] - u[2] * v[1]), 2 * (u[2] * v[0] - u[0] * v[2]),
                         2 * (u[0] * v[1] - u[1] * v[0])};
    const double in[3] = {v[0], v[1], v[2]};
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = in[i] + q[0] * t[i] + u[j] * t[k] - u[k] * t[j];
    }
}

static void normalise(double q[4])
{
    double norm = sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    for (int i = 0; i < 4; i++) {
        q[i] /= norm;
    }
}

void rigid_apply(const rigid *transform, const double point[3], double out[3])
{
    rotate(transform->rotation, point, out);
    for (int i = 0; i < 3; i++) {
        out[i] += transform->position[i];
    }
}

rigid rigid_compose(const rigid *outer, const rigid *inner)
{
    const double *a = outer->rotation, *b = inner->rotation;
    rigid out = {.rotation = {a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3],
                              a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2],
                              a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1],
                              a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0]}};
    normalise(out.rotation);
    rigid_apply(outer, inner->position, out.position);
    return out;
}

rigid rigid_inverse(const rigid *transform)
{
    const double *q = transform->rotation, *p = transform->position;
    rigid out = {.rotation = {q[0], -q[1], -q[2], -q[3]}};
    const double back[3] = {-p[0], -p[1], -p[2]};
    rotate(out.rotation, back, out.position);
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
    normalise(out.rotation);
    return out;
}
