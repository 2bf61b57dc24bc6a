/* SPDX-License-Identifier: Apache-2.0 */
/* Runs a recorded frame through the image stage alone and returns the resulting picture. */
#ifndef TRIM3R_TOOLS_DEVELOPED_FRAME_H
#define TRIM3R_TOOLS_DEVELOPED_FRAME_H

#include <stdint.h>

#include "recording/recording.h"
#include "trim3r.h"

/* Develops frame `index` at width x height into rgb (width x height x 3) and depth (width x height steps of the frame's
 * own unit; NULL: omitted); also returns the camera of the result, undistorted. `path` names the recording in messages.
 * Returns an exit status of cli.h. */
int developed_frame(const t3r_recording *recording, const char *path, uint32_t index, uint32_t width, uint32_t height,
                    uint8_t *rgb, uint16_t *depth, t3r_camera *camera);
/* Develops a frame that was read; `index` is its number in messages. */
int developed_capture(const t3r_capture_frame *frame, const char *path, uint32_t index, uint32_t width, uint32_t height,
                      uint8_t *rgb, uint16_t *depth, t3r_camera *camera);
/* Marks with 255 the pixels of a developed frame that the recorded picture reaches, with 0 those beyond it, which a
 * lens with distortion leaves black: no score counts them. shown: a byte a pixel. Returns an exit status of cli.h. */
int developed_shown(const t3r_capture_frame *frame, const char *path, uint32_t index, uint32_t width, uint32_t height,
                    uint8_t *shown);

#endif
