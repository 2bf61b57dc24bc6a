/* A frame of a recording that can be built from. */
#ifndef TRIM3R_TOOLS_RECORDED_FRAME_H
#define TRIM3R_TOOLS_RECORDED_FRAME_H

#include <stdint.h>

#include "recording/recording.h"

/* Checks whether frames can be read without import; else returns CLI_BAD_INPUT after a message with the command that is
 * needed. */
int recorded_frames_check(const t3r_recording *recording, const char *path);
/* Reads frame `index` of a recording with its pose and intrinsics; CLI_BAD_INPUT with a message otherwise. */
int recorded_frame_read(const t3r_recording *recording, const char *path, uint32_t index, t3r_capture_frame *frame);

#endif
