/* SPDX-License-Identifier: Apache-2.0 */
/* A camera's positions over time, by another clock: a TUM trajectory, EuRoC's table, or a topic of a ROS 2 bag. */
#ifndef TRIM3R_TOOLS_TRAJECTORY_H
#define TRIM3R_TOOLS_TRAJECTORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry/rigid.h"
#include "import/poses/pose_losses.h"

typedef struct trajectory_pose {
    int64_t stamp_ns;
    rigid pose;   /* camera (x right, y down, z forward) to world */
    size_t order; /* in the file */
} trajectory_pose;

typedef struct trajectory {
    trajectory_pose *poses; /* sorted by stamp, without duplicates; heap: trajectory_free() */
    size_t count;
    const char *kind;   /* "TUM", "EuRoC", "bag" */
    pose_losses losses; /* poses that are left out */
} trajectory;

#define TRAJECTORY_BRACKET_NS INT64_C(200000000) /* neighbours farther apart are not interpolated */

/* Reads PATH: an MCAP bag (geometry_msgs PoseStamped or TransformStamped on `topic`, NULL: the only such topic), or a
 * list (pose_list.h). Stamps keep their nanoseconds; of different poses of one time the first is kept, the others are
 * losses. Returns 0, or -1 with "path: line: what" in error[]. */
int trajectory_read(const char *path, const char *topic, trajectory *out, char *error, size_t error_bytes);
/* Parses the text of a list. */
int trajectory_parse(char *text, const char *path, trajectory *out, char *error, size_t error_bytes);
void trajectory_free(trajectory *t);

/* Finds the pose at a time of the trajectory's clock: the stored pose of exactly that time, else interpolated between
 * two that are at most TRAJECTORY_BRACKET_NS apart, with a quaternion of norm 1. False if there is none. Allocates
 * nothing. */
bool trajectory_at(const trajectory *t, int64_t stamp_ns, rigid *pose);
/* Finds the pose at a time of another clock: the trajectory's time is stamp_ns + offset_ns; false if int64_t cannot
 * hold the sum. */
bool trajectory_at_offset(const trajectory *t, int64_t stamp_ns, int64_t offset_ns, rigid *pose);

#endif
