/* SPDX-License-Identifier: Apache-2.0 */
/* Checks that every reader of poses makes. */
#ifndef TRIM3R_TOOLS_POSE_CHECK_H
#define TRIM3R_TOOLS_POSE_CHECK_H

#include "geometry/rigid.h"

/* Returns NULL, or what is wrong: a number that is not finite, a position of 2^T3R_LIMIT_POSITION_LOG2 or more, a
 * quaternion whose norm is not 1 within 0.1. */
const char *pose_check(const rigid *pose);
/* Checks only the position. */
const char *pose_check_position(const double position[3]);

#endif
