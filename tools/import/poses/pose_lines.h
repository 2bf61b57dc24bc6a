/* SPDX-License-Identifier: Apache-2.0 */
/* Texts with an entry a line. Empty lines and those that begin with # hold none. */
#ifndef TRIM3R_TOOLS_POSE_LINES_H
#define TRIM3R_TOOLS_POSE_LINES_H

#include <stdbool.h>
#include <stddef.h>

#include "geometry/rigid.h"

typedef struct pose_lines {
    char *rest; /* of the text, which ends in a 0 and is cut into lines */
    size_t number;
} pose_lines;

/* Returns the next line with an entry, without the blanks before it; NULL after the last. */
char *pose_lines_next(pose_lines *lines);

/* Takes a number after blanks or commas; *text moves past it. False: there is none. */
bool pose_lines_number(char **text, double *value);
/* Takes `tx ty tz qx qy qz qw`, or with w_first `px py pz qw qx qy qz`. */
bool pose_lines_pose(char **text, bool w_first, rigid *pose);

#endif
