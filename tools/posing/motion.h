/* SPDX-License-Identifier: Apache-2.0 */
/* Rotations and motions of cameras, in doubles. Matrices are row-major. */
#ifndef TRIM3R_TOOLS_POSING_MOTION_H
#define TRIM3R_TOOLS_POSING_MOTION_H

/* y = r x + t */
typedef struct motion {
    double r[9], t[3];
} motion;

extern const motion motion_none;

double dot3(const double a[3], const double b[3]);
void cross3(const double a[3], const double b[3], double out[3]);
double norm3(const double a[3]);
/* out = m v, and with m transposed */
void apply3(const double m[9], const double v[3], double out[3]);
void apply3_transposed(const double m[9], const double v[3], double out[3]);
/* out = a b; out is none of them */
void multiply3(const double a[9], const double b[9], double out[9]);
double determinant3(const double m[9]);

void motion_apply(const motion *m, const double x[3], double y[3]);
motion motion_inverse(const motion *m);
/* first `second`, then `first` */
motion motion_after(const motion *first, const motion *second);
/* The rotation by |v| radians about v. */
void rotation_about(const double v[3], double r[9]);
/* Radians between two rotations, and between two directions (0 where one has no length). */
double rotation_angle(const double a[9], const double b[9]);
double direction_angle(const double a[3], const double b[3]);

/* Singular values s, descending, of m = u diag(s) v^T, with rotations or mirrors u and v^T. 0, or -1. */
int singular3(const double m[9], double u[9], double s[3], double vt[9]);

#endif
