/* A frame of a recording that can be built from. */
#ifndef TRIM3R_TOOLS_RECORDED_FRAME_H
#define TRIM3R_TOOLS_RECORDED_FRAME_H

#include <stdint.h>

#include "recording/recording.h"

/* Whether frames can be read as they stand: CLI_BAD_INPUT with the command that is needed otherwise. */
int recorded_frames_check(const t3r_recording *recording, const char *path);
/* Frame `index` of a recording with its pose and intrinsics; CLI_BAD_INPUT with a message otherwise. */
int recorded_frame_read(const t3r_recording *recording, const char *path, uint32_t index, t3r_capture_frame *frame);

#endif
