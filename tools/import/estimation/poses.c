/* SPDX-License-Identifier: Apache-2.0 */
#include "import/estimation/poses.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

#include "cli/cli.h"
#include "core/little_endian.h"
#include "host/reason.h"
#include "import/estimation/focal_lengths.h"
#include "import/frames/frame.h"
#include "messages/fixed_camera.h"
#include "posing/focal.h"

static int look_at(const char *directory, const posed_folder *folder, uint32_t index, const uint32_t size[2],
                   pose_view *view, t3r_camera *camera, char *error, size_t error_bytes)
{
    import_buffers buffers;
    t3r_recorded_frame recorded;
    posed_frame from = folder->frames[index];
    uint32_t sides[2];
    const bool known = import_picture_size(directory, &from, &sides[0], &sides[1], error, error_bytes) == 0;
    const bool large = known && (sides[0] > T3R_MAX_SIDE || sides[1] > T3R_MAX_SIDE);
    if (known && focal_length_is_unknown(&from)) {
        from.intrinsics.fx = FOCAL_USUAL * fmax(sides[0], sides[1]);
    }
    int status = import_frame(directory, &from, NULL, large ? size[0] : 0, large ? size[1] : 0, &buffers, &recorded,
                              error, error_bytes);
    if (status == 0) {
        (void)t3r_fixed_camera(&recorded.camera, camera); /* cannot fail: import_frame() has checked it */
        t3r_frame frame = {.format = recorded.format, .width = recorded.width, .height = recorded.height};
        frame.planes[0] = recorded.planes[0];
        frame.stride_bytes[0] = recorded.stride_bytes[0];
        if (recorded.depth != NULL) {
            size_t count = (size_t)recorded.depth_width * recorded.depth_height;
            uint8_t *bytes = (uint8_t *)buffers.depth;
            for (size_t i = 0; i < count; i++) {
                t3r_store_le16(bytes + 2 * i, buffers.depth[i]);
            }
            (void)t3r_fixed_depth_unit(folder->depth_unit,
                                       &frame.depth_unit_q40); /* cannot fail: the folder's reader has checked it */
            frame.depth = bytes;
            frame.depth_width = recorded.depth_width;
            frame.depth_height = recorded.depth_height;
            frame.depth_stride_bytes = recorded.depth_width * 2;
        }
        char reason[256];
        if (pose_view_make(&frame, camera, view, reason, sizeof reason) != 0) {
            status = t3r_reason(error, error_bytes, "%s: %s", folder->frames[index].image, reason);
        }
    }
    import_buffers_free(&buffers);
    return status;
}

/* Sets the pose exactly: dividing by 2^30 and 2^32 keeps a double's mantissa while positions are below 2^20 units;
 * beyond, a few last bits are lost. */
static void set_pose(posed_frame *frame, const t3r_camera *camera)
{
    for (int i = 0; i < 3; i++) {
        frame->pose.position[i] = ldexp((double)camera->position_q32[i], -32);
    }
    for (int i = 0; i < 4; i++) {
        frame->pose.rotation[i] = ldexp(camera->rotation_q30[i], -30);
    }
}

/* Estimates the focal length of the frames without one, which they share. */
static void estimate_focal_length(const char *directory, posed_folder *folder, pose_view *views)
{
    const double share = FOCAL_USUAL * focal_estimate(views, folder->frame_count);
    focal_lengths_set(directory, folder, share);
    (void)t3r_reason(folder->focal, sizeof folder->focal,
                     "estimated from the pictures, %.2f of the longer side; --intrinsics gives it", share);
}

static int estimate(const char *directory, posed_folder *folder, const uint32_t size[2], poses_source source,
                    pose_view *views, rigid *poses, t3r_camera *cameras, pose_account *accounts, char *error,
                    size_t error_bytes)
{
    if (poses_check_count(folder->frame_count, error, error_bytes) != 0) {
        return -1;
    }
    focal_lengths_from_exif(directory, folder);
    bool unknown = false;
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        char reason[512];
        unknown = unknown || focal_length_is_unknown(&folder->frames[i]);
        cli_progress("looking for features", i, folder->frame_count);
        const int status = look_at(directory, folder, i, size, &views[i], &cameras[i], reason, sizeof reason);
        if (status != 0) {
            (void)t3r_reason(error, error_bytes, "frame %u: %s", i, reason);
            return status;
        }
    }
    if (unknown) {
        estimate_focal_length(directory, folder, views);
    }
    if (poses_estimate(views, folder->frame_count, source, NULL, poses, accounts, error, error_bytes) != 0) {
        return -1;
    }
    const uint32_t first = poses_find(accounts, 0, folder->frame_count, true);
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        t3r_camera camera = cameras[first];
        folder->frames[i].posed = accounts[i].why[0] == '\0';
        if (!folder->frames[i].posed) {
            continue;
        }
        if (i != first && pose_store(&poses[i], &cameras[first], &camera) != 0) {
            return t3r_reason(error, error_bytes, "frame %u: its position is out of range", i);
        }
        set_pose(&folder->frames[i], &camera);
        folder->frames[i].upright = true;
    }
    return 0;
}

int import_estimate_poses(const char *directory, posed_folder *folder, uint32_t width, uint32_t height,
                          poses_source source, pose_account *accounts, char *error, size_t error_bytes)
{
    pose_view *views = calloc(folder->frame_count, sizeof *views);
    rigid *poses = calloc(folder->frame_count, sizeof *poses);
    t3r_camera *cameras = calloc(folder->frame_count, sizeof *cameras);
    int status = views != NULL && poses != NULL && cameras != NULL
                     ? estimate(directory, folder, (const uint32_t[]){width, height}, source, views, poses, cameras,
                                accounts, error, error_bytes)
                     : t3r_reason(error, error_bytes, "out of memory");
    for (uint32_t i = 0; views != NULL && i < folder->frame_count; i++) {
        pose_view_free(&views[i]);
    }
    free(views);
    free(poses);
    free(cameras);
    return status;
}
