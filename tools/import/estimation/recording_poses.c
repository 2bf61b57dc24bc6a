/* SPDX-License-Identifier: Apache-2.0 */
#include "import/estimation/recording_poses.h"

#include <inttypes.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"

#define ERROR_BYTES 512

/* Finds the features of the frame; its pose, or the origin, goes to `camera`. */
static int look_at(const t3r_recording *recording, const char *path, uint32_t index, pose_view *view,
                   t3r_camera *camera)
{
    t3r_capture_frame frame;
    char error[ERROR_BYTES] = "";
    uint32_t frames = t3r_recording_frame_count(recording);
    if (index >= frames) {
        return cli_error(CLI_BAD_INPUT, "%s: there is no frame %" PRIu32 ": the recording holds %" PRIu32, path, index,
                         frames);
    }
    char lost[ERROR_BYTES]; /* depth or a pose that cannot be read is not needed */
    if (t3r_recording_frame_readable(recording, index, &frame, lost, sizeof lost, error, sizeof error) !=
        T3R_CAPTURE_FRAME) {
        return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 ": %s", path, index, error);
    }
    if (!frame.has_intrinsics) {
        return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 " has no camera_info", path, index);
    }
    *camera = frame.camera;
    if (!frame.has_pose) {
        memset(camera->position_q32, 0, sizeof camera->position_q32);
        memset(camera->rotation_q30, 0, sizeof camera->rotation_q30);
        camera->rotation_q30[0] = 1 << 30;
    }
    if (pose_view_make(&frame.frame, &frame.camera, view, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 ": %s", path, index, error);
    }
    return CLI_OK;
}

static int estimate(t3r_recording *recording, const char *path, const uint32_t *frames, uint32_t count,
                    poses_source source, pose_account *accounts, pose_view *views, rigid *poses, t3r_camera *cameras)
{
    char error[ERROR_BYTES] = "";
    if (poses_check_count(count, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", path, error);
    }
    for (uint32_t i = 0; i < count; i++) {
        int code = look_at(recording, path, frames[i], &views[i], &cameras[i]);
        if (code != CLI_OK) {
            return code;
        }
    }
    if (poses_estimate(views, count, source, frames, poses, accounts, error, sizeof error) != 0) {
        return cli_error(CLI_BAD_INPUT, "%s: %s", path, error);
    }
    const uint32_t first = poses_find(accounts, 0, count, true);
    for (uint32_t i = first; i < count; i = poses_find(accounts, i + 1, count, true)) {
        t3r_camera camera = cameras[first]; /* the first view keeps every bit */
        if (i > first && pose_store(&poses[i], &cameras[first], &camera) != 0) {
            return cli_error(CLI_BAD_INPUT, "%s: frame %" PRIu32 ": its position is out of range", path, frames[i]);
        }
        if (t3r_recording_set_pose(recording, frames[i], camera.position_q32, camera.rotation_q30) != 0) {
            return cli_error(CLI_BAD_INPUT, "out of memory");
        }
    }
    return CLI_OK;
}

int recording_estimate_poses(t3r_recording *recording, const char *path, const uint32_t *frames, uint32_t count,
                             poses_source source, pose_account *accounts)
{
    pose_view *views = calloc(count, sizeof *views);
    rigid *poses = calloc(count, sizeof *poses);
    t3r_camera *cameras = calloc(count, sizeof *cameras);
    int code = views != NULL && poses != NULL && cameras != NULL
                   ? estimate(recording, path, frames, count, source, accounts, views, poses, cameras)
                   : cli_error(CLI_BAD_INPUT, "out of memory");
    for (uint32_t i = 0; views != NULL && i < count; i++) {
        pose_view_free(&views[i]);
    }
    free(views);
    free(poses);
    free(cameras);
    return code;
}

int recording_pose_views(t3r_recording *recording, const char *path, const uint32_t *frames, uint32_t count,
                         poses_source source, pose_account *accounts)
{
    char why[ERROR_BYTES];
    const int code = recording_estimate_poses(recording, path, frames, count, source, accounts);
    const uint32_t left = code == CLI_OK ? poses_find(accounts, 0, count, false) : count;
    if (left == count) {
        return code;
    }
    (void)pose_refusal(accounts, left, frames, why, sizeof why);
    return cli_error(CLI_BAD_INPUT, "%s: %s", path, why);
}
