/* Estimates how far a trajectory's clock is ahead of the camera's from the motion of the picture. The motion is
 * measured by matching whole neighbouring frames at a small size, and predicted from the rotation and translation
 * between the poses. The result is the offset at which the prediction explains the motion best. */
#ifndef TRIM3R_TOOLS_CLOCK_OFFSET_H
#define TRIM3R_TOOLS_CLOCK_OFFSET_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

#include "import/poses/trajectory.h"
#include "trim3r.h"

enum { CLOCK_COLUMNS = 80, CLOCK_ROWS = 60 }; /* working size of the pictures */

/* Motion of the picture from one frame to the next, relative to its width and height. */
typedef struct clock_motion {
    int64_t from_ns, to_ns;
    double right, down;
} clock_motion;

/* A small picture with its mean subtracted. */
typedef struct clock_picture {
    float value[CLOCK_ROWS][CLOCK_COLUMNS];
} clock_picture;

void clock_picture_of(const t3r_frame *frame, clock_picture *out);
/* Measures the motion from one picture to the next; the caller sets the stamps. */
void clock_motion_of(const clock_picture *before, const clock_picture *after, clock_motion *out);

typedef struct clock_offset {
    int64_t offset_ns; /* trajectory's time minus camera's */
    double explained;  /* of the motion's variance, 0..1 */
    double runner_up;  /* best explained share at least 50 ms away */
} clock_offset;

/* Searches offsets within +-range_ns of `around_ns`, both below 2^62. Returns 0, or -1 with a reason: too few frames
 * with poses, too little motion, or an ambiguous result. */
int clock_offset_estimate(const clock_motion *motions, size_t count, const trajectory *t, int64_t around_ns,
                          int64_t range_ns, clock_offset *out, char *error, size_t error_bytes);

#endif
