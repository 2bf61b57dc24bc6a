/* SPDX-License-Identifier: Apache-2.0 */
#include "cli/files/recorded_frame.h"

#include <inttypes.h>

#include "cli/cli.h"

int recorded_frames_check(const t3r_recording *recording, const char *path)
{
    const char *reason = t3r_recording_import_reason(recording);
    return reason[0] == '\0'
               ? CLI_OK
               : cli_error(CLI_BAD_INPUT, "%s: %s; first make a recording of it: trim3r import %s -o NAME.mcap", path,
                           reason, path);
}

int recorded_frame_read(const t3r_recording *recording, const char *path, uint32_t index, t3r_capture_frame *frame)
{
    if (recorded_frames_check(recording, path) != CLI_OK) {
        return CLI_BAD_INPUT;
    }
    uint32_t count = t3r_recording_frame_count(recording);
    if (index >= count) {
        return cli_error(CLI_BAD_INPUT,
                         "%s: there is no frame %" PRIu32 ": the recording holds %" PRIu32 " (0 is the first)", path,
                         index, count);
    }
    char error[512] = "";
    if (t3r_recording_frame(recording, index, frame, error, sizeof error) != T3R_CAPTURE_FRAME) {
        return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 ": %s", path, index, error);
    }
    if (!frame->has_pose || !frame->has_intrinsics) {
        return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 " has no %s", path, index,
                         frame->has_pose ? "camera_info" : "pose");
    }
    return CLI_OK;
}
