/* Rotations as quaternions and as matrices, in double. */
#ifndef TRIM3R_TOOLS_QUATERNION_H
#define TRIM3R_TOOLS_QUATERNION_H

/* Unit quaternion w x y z to a row-major matrix. */
void quaternion_matrix(const double quaternion[4], double matrix[9]);
/* A camera-to-world rotation (row-major, camera axes x right, y down, z forward) to a unit quaternion: entries finite,
 * orthonormal within 1e-3, determinant +1. NULL, or what is wrong with it. */
const char *quaternion_of(const double matrix[9], double quaternion[4]);

#endif
