/* Where a camera was over time, by somebody else's clock: a TUM trajectory, EuRoC's table, or a topic of a ROS 2 bag.
 */
#ifndef TRIM3R_TOOLS_TRAJECTORY_H
#define TRIM3R_TOOLS_TRAJECTORY_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry/rigid.h"

typedef struct trajectory_pose {
    int64_t stamp_ns;
    rigid pose; /* camera (x right, y down, z forward) to world */
} trajectory_pose;

typedef struct trajectory {
    trajectory_pose *poses; /* by stamp, no two alike; heap: trajectory_free() */
    size_t count;
    const char *kind; /* "TUM", "EuRoC", "bag" */
} trajectory;

#define TRAJECTORY_BRACKET_NS INT64_C(200000000) /* neighbours farther apart than this are no path */

/* Reads PATH: an MCAP bag (geometry_msgs PoseStamped or TransformStamped on `topic`, NULL: the only such topic), lines
 * `seconds tx ty tz qx qy qz qw` (TUM), or `nanoseconds,px,py,pz,qw,qx,qy,qz,...` (EuRoC). Stamps are kept to the
 * nanosecond. 0, or -1 with "path: line: what" in error[]. */
int trajectory_read(const char *path, const char *topic, trajectory *out, char *error, size_t error_bytes);
/* The texts of the two line formats, told apart by the commas. */
int trajectory_parse(char *text, const char *path, trajectory *out, char *error, size_t error_bytes);
void trajectory_free(trajectory *t);

/* The pose at a time of the trajectory's clock: one of that very time as it was read, else between two that are at most
 * TRAJECTORY_BRACKET_NS apart, its quaternion of norm 1. False where there is none; no memory is asked for. */
bool trajectory_at(const trajectory *t, int64_t stamp_ns, rigid *pose);
/* The pose at a time of another clock, `offset_ns` behind the trajectory's; no time of int64_t: none. */
bool trajectory_at_offset(const trajectory *t, int64_t stamp_ns, int64_t offset_ns, rigid *pose);

#endif
