/* Where the firmware's frames come from. A firmware links one of the sources: frames_recording.c reads a recording, and
 * frames_planes.c reads planes as a camera's driver leaves them. What cannot be read is told, and ends the firmware. */
#ifndef T3R_BAREMETAL_FRAMES_H
#define T3R_BAREMETAL_FRAMES_H

#include "trim3r.h"

/* The memory of a frame: its pixels, and frames_head_bytes each. */
typedef struct frames_room {
    uint8_t *colour, *depth;
    size_t colour_bytes, depth_bytes;
} frames_room;

/* What a plane takes besides its pixels, in bytes. */
extern const size_t frames_head_bytes;

/* Opens a file of frames, each of which is `width` x `height`. */
void frames_open(const char *path, uint32_t width, uint32_t height, const frames_room *room);

/* The next frame with its camera. Its planes lie in the room until the next call. */
void frames_next(t3r_frame *frame, t3r_camera *camera);

#endif
