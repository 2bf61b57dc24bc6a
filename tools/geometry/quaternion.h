/* SPDX-License-Identifier: Apache-2.0 */
/* Rotations in doubles, as quaternions w x y z and as row-major matrices. A rotation turns what a camera, or any child,
 * sees into the axes of its parent. Camera axes are x right, y down, z forward. */
#ifndef TRIM3R_TOOLS_QUATERNION_H
#define TRIM3R_TOOLS_QUATERNION_H

double quaternion_norm(const double q[4]);
/* Gives it the norm 1, which it must not be too small for. */
void quaternion_normalise(double q[4]);
/* First b, then a; `out` is neither of them. */
void quaternion_multiply(const double a[4], const double b[4], double out[4]);
/* The way back. */
void quaternion_conjugate(const double q[4], double out[4]);
/* Rotates v by a unit quaternion; `out` may be v. */
void quaternion_rotate(const double q[4], const double v[3], double out[3]);

/* Unit quaternion to matrix. */
void quaternion_matrix(const double q[4], double matrix[9]);
/* Rotation matrix to unit quaternion, w >= 0. */
void quaternion_of_rotation(const double matrix[9], double q[4]);
/* The same of a matrix from elsewhere: entries finite, orthonormal within 1e-3, determinant +1. NULL, or what is wrong
 * with it. */
const char *quaternion_of(const double matrix[9], double q[4]);

/* `out` is not v. */
void matrix_apply(const double matrix[9], const double v[3], double out[3]);
double matrix_determinant(const double matrix[9]);

#endif
