/* SPDX-License-Identifier: Apache-2.0 */
#include "viewer/camera_path.h"

void camera_path_read(const t3r_recording *recording, camera_path *out)
{
    const uint32_t frames = t3r_recording_frame_count(recording);
    const uint32_t wanted = frames < CAMERA_PATH_MOST ? frames : CAMERA_PATH_MOST;
    out->count = 0;
    for (uint32_t i = 0; i < wanted; i++) {
        const uint32_t index = wanted > 1 ? (uint32_t)((uint64_t)i * (frames - 1) / (wanted - 1)) : 0;
        char lost[256], error[256];
        t3r_capture_frame frame;
        if (t3r_recording_frame_readable(recording, index, &frame, lost, sizeof lost, error, sizeof error) ==
                T3R_CAPTURE_FRAME &&
            frame.has_pose) {
            out->places[out->count++] = frame.camera;
        }
    }
}
