/* SPDX-License-Identifier: Apache-2.0 */
/* The source of the firmware's frames. A firmware links one: frames_recording.c reads a recording; frames_planes.c
 * reads planes like a camera driver's. A read error is reported and ends the firmware. */
#ifndef T3R_BAREMETAL_FRAMES_H
#define T3R_BAREMETAL_FRAMES_H

#include "trim3r.h"

/* The memory of a strip: rows of R G B, and equally many rows of depth. */
typedef struct frames_strip {
    uint8_t *colour, *depth;
    uint32_t rows;
} frames_strip;

/* Opens a file of frames whose colour and depth are `width` x `height`. */
void frames_open(const char *path, uint32_t width, uint32_t height, const frames_strip *strip);

/* Reads the next frame and its camera, without planes. */
void frames_next(t3r_frame *frame, t3r_camera *camera);

/* Reads at most a strip of the frame's rows, from `row` on; the planes begin with them. They are valid until the next
 * call. */
void frames_rows(t3r_frame *frame, uint32_t row, uint32_t rows);

#endif
