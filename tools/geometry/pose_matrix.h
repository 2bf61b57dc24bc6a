/* SPDX-License-Identifier: Apache-2.0 */
/* Poses as matrices, in the conventions of other programs' files. */
#ifndef TRIM3R_TOOLS_POSE_MATRIX_H
#define TRIM3R_TOOLS_POSE_MATRIX_H

#include "geometry/rigid.h"
#include "trim3r_host.h"

/* Converts a camera-to-world matrix, row-major, whose last row is 0 0 0 1, to a pose of a camera with the axes of
 * OpenCV. Returns NULL, or what is wrong: an entry that is not finite, an invalid rotation, a position of
 * 2^T3R_LIMIT_POSITION_LOG2 or more. */
const char *pose_of_matrix(const double matrix[16], t3r_axes axes, rigid *pose);

/* Converts a pose in a convention, a sum of t3r_axes, to one of a camera to the world with the axes of OpenCV. */
rigid pose_of_convention(const rigid *pose, uint32_t axes);

#endif
