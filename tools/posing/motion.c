/* SPDX-License-Identifier: Apache-2.0 */
#include "posing/motion.h"

#include <lapacke.h>
#include <math.h>
#include <string.h>

const motion motion_none = {.r = {1, 0, 0, 0, 1, 0, 0, 0, 1}};

double dot3(const double a[3], const double b[3])
{
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

void cross3(const double a[3], const double b[3], double out[3])
{
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}

double norm3(const double a[3])
{
    return sqrt(dot3(a, a));
}

void apply3(const double m[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = dot3(m + 3 * i, v);
    }
}

void apply3_transposed(const double m[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = m[i] * v[0] + m[3 + i] * v[1] + m[6 + i] * v[2];
    }
}

void multiply3(const double a[9], const double b[9], double out[9])
{
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out[3 * i + j] = a[3 * i] * b[j] + a[3 * i + 1] * b[3 + j] + a[3 * i + 2] * b[6 + j];
        }
    }
}

double determinant3(const double m[9])
{
    double c[3];
    cross3(m, m + 3, c);
    return dot3(c, m + 6);
}

void motion_apply(const motion *m, const double x[3], double y[3])
{
    apply3(m->r, x, y);
    for (int i = 0; i < 3; i++) {
        y[i] += m->t[i];
    }
}

motion motion_inverse(const motion *m)
{
    motion out;
    for (int i = 0; i < 3; i++) {
        for (int j = 0; j < 3; j++) {
            out.r[3 * i + j] = m->r[3 * j + i];
        }
    }
    apply3(out.r, m->t, out.t);
    for (int i = 0; i < 3; i++) {
        out.t[i] = -out.t[i];
    }
    return out;
}

motion motion_after(const motion *first, const motion *second)
{
    motion out;
    multiply3(first->r, second->r, out.r);
    motion_apply(first, second->t, out.t);
    return out;
}

void rotation_about(const double v[3], double r[9])
{
    double angle = norm3(v);
    /* sin(a) / a and (1 - cos(a)) / a^2 by their series where the quotients lose digits */
    double s = angle < 1e-4 ? 1 - angle * angle / 6 : sin(angle) / angle;
    double c = angle < 1e-4 ? 0.5 - angle * angle / 24 : (1 - cos(angle)) / (angle * angle);
    const double k[9] = {0, -v[2], v[1], v[2], 0, -v[0], -v[1], v[0], 0};
    double square[9];
    multiply3(k, k, square);
    for (int i = 0; i < 9; i++) {
        r[i] = motion_none.r[i] + s * k[i] + c * square[i];
    }
}

double rotation_angle(const double a[9], const double b[9])
{
    /* |a - b| = 2 sqrt(2) sin(angle / 2): exact for small angles too */
    double sum = 0;
    for (int i = 0; i < 9; i++) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return 2 * asin(fmin(1, sqrt(sum / 8)));
}

double direction_angle(const double a[3], const double b[3])
{
    double c[3];
    cross3(a, b, c);
    return atan2(norm3(c), dot3(a, b));
}

int singular3(const double m[9], double u[9], double s[3], double vt[9])
{
    double a[9], superb[3];
    memcpy(a, m, sizeof a);
    return LAPACKE_dgesvd(LAPACK_ROW_MAJOR, 'A', 'A', 3, 3, a, 3, s, u, 3, vt, 3, superb) == 0 ? 0 : -1;
}
