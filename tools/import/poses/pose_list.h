/* SPDX-License-Identifier: Apache-2.0 */
/* Lists with a pose a line, the same for all commands: `seconds tx ty tz qx qy qz qw` (TUM), or
 * `nanoseconds,px,py,pz,qw,qx,qy,qz,...` (EuRoC), which commas after a whole number distinguish. Empty lines and those
 * that begin with # hold none.
 *
 * A line is left out if it is none of these, as a row of a matrix, if a number is not finite, a position
 * 2^T3R_LIMIT_POSITION_LOG2 or more, or a quaternion without direction. Quaternions are normalised where their norm is
 * not 1 within 0.1. */
#ifndef TRIM3R_TOOLS_POSE_LIST_H
#define TRIM3R_TOOLS_POSE_LIST_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "geometry/rigid.h"
#include "import/poses/pose_losses.h"

#define POSE_LIST_MAX_SECONDS INT64_C(4000000000)

typedef struct pose_list_item {
    double seconds;
    int64_t stamp_ns; /* the same time exactly; -1: outside 0..POSE_LIST_MAX_SECONDS, or written with an exponent */
    rigid pose;
} pose_list_item;

/* Initialise with zeros, except `rest` and `exact`. */
typedef struct pose_list {
    char *rest;  /* of the text, which ends in a 0 and is cut into lines */
    bool exact;  /* leave out lines whose stamp_ns would be -1 */
    bool euroc;  /* a line was EuRoC's */
    size_t line; /* number of the current line */
    uint64_t count;
    pose_losses losses;
} pose_list;

/* Reads the next pose; false after the last, and after more than T3R_LIMIT_POSES. */
bool pose_list_next(pose_list *list, pose_list_item *out);
/* Returns 0 if the whole list was read and has poses, or -1 with "path: line: what" in error[]. */
int pose_list_end(const pose_list *list, const char *path, char *error, size_t error_bytes);

#endif
