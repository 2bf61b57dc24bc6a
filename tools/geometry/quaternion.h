/* SPDX-License-Identifier: Apache-2.0 */
/* Rotations in doubles, as quaternions w x y z and as row-major matrices. A rotation turns vectors from the axes of a
 * camera, or any child, to its parent's. Camera axes are x right, y down, z forward. */
#ifndef TRIM3R_TOOLS_QUATERNION_H
#define TRIM3R_TOOLS_QUATERNION_H

double quaternion_norm(const double q[4]);
/* Normalises q, whose norm must not be near 0. */
void quaternion_normalise(double q[4]);
/* Computes the rotation b followed by a; `out` must be neither of them. */
void quaternion_multiply(const double a[4], const double b[4], double out[4]);
/* Computes the inverse rotation. */
void quaternion_conjugate(const double q[4], double out[4]);
/* Rotates v by a unit quaternion; `out` may be v. */
void quaternion_rotate(const double q[4], const double v[3], double out[3]);

/* Converts a unit quaternion to a matrix. */
void quaternion_matrix(const double q[4], double matrix[9]);
/* Converts a rotation matrix to a unit quaternion, w >= 0. */
void quaternion_of_rotation(const double matrix[9], double q[4]);
/* Converts a matrix from elsewhere: its entries must be finite, orthonormal within 1e-3, determinant +1. Returns NULL,
 * or what is wrong. */
const char *quaternion_of(const double matrix[9], double q[4]);

/* Computes the matrix times v; `out` must not be v. */
void matrix_apply(const double matrix[9], const double v[3], double out[3]);
double matrix_determinant(const double matrix[9]);

#endif
