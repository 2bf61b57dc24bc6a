/* A recorded frame through the image stage alone: what the runtime makes of it, as a picture. */
#ifndef TRIM3R_TOOLS_DEVELOPED_FRAME_H
#define TRIM3R_TOOLS_DEVELOPED_FRAME_H

#include <stdint.h>

#include "recording/recording.h"
#include "trim3r.h"

/* Frame `index` at width x height, into rgb (width x height x 3) and depth (width x height steps of the frame's own
 * unit; NULL: it is left out), and the camera of the result, undistorted. `path` names the recording in messages. An
 * exit status of cli.h. */
int developed_frame(const t3r_recording *recording, const char *path, uint32_t index, uint32_t width, uint32_t height,
                    uint8_t *rgb, uint16_t *depth, t3r_camera *camera);

#endif
