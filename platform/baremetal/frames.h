/* Where the firmware's frames come from. A firmware links one of the sources: frames_recording.c reads a recording, and
 * frames_planes.c reads planes as a camera's driver leaves them. What cannot be read is told, and ends the firmware. */
#ifndef T3R_BAREMETAL_FRAMES_H
#define T3R_BAREMETAL_FRAMES_H

#include "trim3r.h"

/* The memory of a strip: rows of R G B, and as many of depth. */
typedef struct frames_strip {
    uint8_t *colour, *depth;
    uint32_t rows;
} frames_strip;

/* Opens a file of frames, colour and depth of each of which are `width` x `height`. */
void frames_open(const char *path, uint32_t width, uint32_t height, const frames_strip *strip);

/* The next frame with its camera, but for its planes. */
void frames_next(t3r_frame *frame, t3r_camera *camera);

/* Rows of it from `row` on, at most those of a strip, which its planes then begin with; they lie there until the next
 * call. */
void frames_rows(t3r_frame *frame, uint32_t row, uint32_t rows);

#endif
