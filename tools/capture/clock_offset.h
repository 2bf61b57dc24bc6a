/* How much a trajectory's clock is ahead of the camera's, from how the picture moves: how far is told by matching
 * neighbouring frames, made small, as a whole; how far it should be by the rotation and the translation between the
 * poses; the offset at which one explains the other best is the answer. */
#ifndef TRIM3R_TOOLS_CLOCK_OFFSET_H
#define TRIM3R_TOOLS_CLOCK_OFFSET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "import/poses/trajectory.h"
#include "trim3r.h"

enum { CLOCK_COLUMNS = 80, CLOCK_ROWS = 60 }; /* pictures are looked at in this size */

/* How much the picture moved from one frame to the next, as shares of its width and height. */
typedef struct clock_motion {
    int64_t from_ns, to_ns;
    double right, down;
} clock_motion;

/* A picture made small, its mean taken off. */
typedef struct clock_picture {
    float value[CLOCK_ROWS][CLOCK_COLUMNS];
} clock_picture;

void clock_picture_of(const t3r_frame *frame, clock_picture *out);
/* From one picture to the next; stamps are the caller's. */
void clock_motion_of(const clock_picture *before, const clock_picture *after, clock_motion *out);

typedef struct clock_offset {
    int64_t offset_ns; /* trajectory's time less camera's */
    double explained;  /* of the motion's variance, 0..1 */
    double runner_up;  /* the best explained elsewhere, 50 ms away or more */
} clock_offset;

/* Searches offsets within +-range_ns of `around_ns`, both below 2^62. 0, or -1 with a reason: too few frames with
 * poses, too little motion, or an answer that is not clear. */
int clock_offset_estimate(const clock_motion *motions, size_t count, const trajectory *t, int64_t around_ns,
                          int64_t range_ns, clock_offset *out, char *error, size_t error_bytes);

#endif
