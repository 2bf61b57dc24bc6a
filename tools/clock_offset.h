/* How much a trajectory's clock is ahead of the camera's, from how the picture moves: the shift between neighbouring
 * frames is told by their row and column sums, what it should be by the rotation and the translation between the poses;
 * the offset at which one explains the other best is the answer. */
#ifndef TRIM3R_TOOLS_CLOCK_OFFSET_H
#define TRIM3R_TOOLS_CLOCK_OFFSET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "trajectory.h"
#include "trim3r.h"

#define CLOCK_OFFSET_SIDE 96u /* pictures are looked at as so many columns and rows */

/* How much the picture moved from one frame to the next, as shares of its width and height. */
typedef struct clock_motion {
    int64_t from_ns, to_ns;
    double right, down;
} clock_motion;

/* The profiles of one picture. */
typedef struct clock_profiles {
    double column[CLOCK_OFFSET_SIDE], row[CLOCK_OFFSET_SIDE];
} clock_profiles;

void clock_profiles_of(const t3r_frame *frame, clock_profiles *out);
/* From the profiles of two neighbours; stamps are the caller's. */
void clock_motion_of(const clock_profiles *before, const clock_profiles *after, clock_motion *out);

typedef struct clock_offset {
    int64_t offset_ns; /* trajectory's time less camera's */
    double explained;  /* of the motion's variance, 0..1 */
    double runner_up;  /* the best explained elsewhere, 50 ms away or more */
} clock_offset;

/* Searches offsets within +-range_ns of `around_ns`. 0, or -1 with a reason: too few frames with poses, too little
 * motion, or an answer that is not clear. */
int clock_offset_estimate(const clock_motion *motions, size_t count, const trajectory *t, int64_t around_ns,
                          int64_t range_ns, clock_offset *out, char *error, size_t error_bytes);

#endif
