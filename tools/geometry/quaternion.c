/* SPDX-License-Identifier: Apache-2.0 */
#include "geometry/quaternion.h"

#include <math.h>
#include <string.h>

double quaternion_norm(const double q[4])
{
    return sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
}

void quaternion_normalise(double q[4])
{
    const double norm = quaternion_norm(q);
    for (int i = 0; i < 4; i++) {
        q[i] /= norm;
    }
}

void quaternion_multiply(const double a[4], const double b[4], double out[4])
{
    out[0] = a[0] * b[0] - a[1] * b[1] - a[2] * b[2] - a[3] * b[3];
    out[1] = a[0] * b[1] + a[1] * b[0] + a[2] * b[3] - a[3] * b[2];
    out[2] = a[0] * b[2] - a[1] * b[3] + a[2] * b[0] + a[3] * b[1];
    out[3] = a[0] * b[3] + a[1] * b[2] - a[2] * b[1] + a[3] * b[0];
}

void quaternion_conjugate(const double q[4], double out[4])
{
    out[0] = q[0];
    for (int i = 1; i < 4; i++) {
        out[i] = -q[i];
    }
}

void quaternion_rotate(const double q[4], const double v[3], double out[3])
{
    const double *u = q + 1, in[3] = {v[0], v[1], v[2]};
    const double t[3] = {2 * (u[1] * v[2] - u[2] * v[1]), 2 * (u[2] * v[0] - u[0] * v[2]),
                         2 * (u[0] * v[1] - u[1] * v[0])};
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        out[i] = in[i] + q[0] * t[i] + u[j] * t[k] - u[k] * t[j];
    }
}

void matrix_apply(const double m[9], const double v[3], double out[3])
{
    for (int i = 0; i < 3; i++) {
        out[i] = m[3 * i] * v[0] + m[3 * i + 1] * v[1] + m[3 * i + 2] * v[2];
    }
}

double matrix_determinant(const double m[9])
{
    return m[0] * (m[4] * m[8] - m[5] * m[7]) - m[1] * (m[3] * m[8] - m[5] * m[6]) + m[2] * (m[3] * m[7] - m[4] * m[6]);
}

/* Replaces R by the nearest rotation: Newton's iteration for the polar factor, R <- R (3 I - R^T R) / 2. Quadratic: an
 * error of 1e-3 is below 1e-12 after two steps. */
static void orthonormalise(double r[9])
{
    for (int step = 0; step < 3; step++) {
        double next[9];
        for (int row = 0; row < 3; row++) {
            for (int column = 0; column < 3; column++) {
                double sum = 0;
                for (int k = 0; k < 3; k++) {
                    double gram = r[k] * r[column] + r[3 + k] * r[3 + column] + r[6 + k] * r[6 + column];
                    sum += r[row * 3 + k] * ((k == column ? 3.0 : 0.0) - gram);
                }
                next[row * 3 + column] = sum / 2;
            }
        }
        memcpy(r, next, sizeof next);
    }
}

/* Shepperd's method: divides by the largest of the four components, which is at least 1/2. */
void quaternion_of_rotation(const double r[9], double q[4])
{
    double trace = r[0] + r[4] + r[8];
    double squares[4] = {trace, r[0], r[4], r[8]};
    int largest = 0;
    for (int i = 1; i < 4; i++) {
        if (squares[i] > squares[largest]) {
            largest = i;
        }
    }
    if (largest == 0) {
        q[0] = 1 + trace;
        q[1] = r[7] - r[5];
        q[2] = r[2] - r[6];
        q[3] = r[3] - r[1];
    } else {
        int i = largest - 1, j = (i + 1) % 3, k = (i + 2) % 3;
        q[0] = r[k * 3 + j] - r[j * 3 + k];
        q[1 + i] = 1 + r[i * 3 + i] - r[j * 3 + j] - r[k * 3 + k];
        q[1 + j] = r[i * 3 + j] + r[j * 3 + i];
        q[1 + k] = r[i * 3 + k] + r[k * 3 + i];
    }
    const double norm = q[0] < 0 ? -quaternion_norm(q) : quaternion_norm(q);
    for (int i = 0; i < 4; i++) {
        q[i] /= norm;
    }
}

const char *quaternion_of(const double matrix[9], double quaternion[4])
{
    for (int i = 0; i < 9; i++) {
        if (!isfinite(matrix[i])) {
            return "an entry is not finite";
        }
    }
    for (int a = 0; a < 3; a++) {
        for (int b = a; b < 3; b++) {
            double dot = matrix[a] * matrix[b] + matrix[3 + a] * matrix[3 + b] + matrix[6 + a] * matrix[6 + b];
            if (!(fabs(dot - (a == b ? 1.0 : 0.0)) <= 1e-3)) {
                return "the rotation is not orthonormal within 1e-3";
            }
        }
    }
    if (matrix_determinant(matrix) < 0) {
        return "the rotation mirrors (its determinant is -1)";
    }
    double r[9];
    memcpy(r, matrix, sizeof r);
    orthonormalise(r);
    quaternion_of_rotation(r, quaternion);
    return NULL;
}

void quaternion_matrix(const double q[4], double m[9])
{
    for (int i = 0; i < 3; i++) {
        int j = (i + 1) % 3, k = (i + 2) % 3;
        const double *v = q + 1;
        m[3 * i + i] = 1 - 2 * (v[j] * v[j] + v[k] * v[k]);
        m[3 * i + j] = 2 * (v[i] * v[j] - q[0] * v[k]);
        m[3 * i + k] = 2 * (v[i] * v[k] + q[0] * v[j]);
    }
}
