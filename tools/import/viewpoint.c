/* SPDX-License-Identifier: Apache-2.0 */
#include "import/viewpoint.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "cli/tables/json_input.h"
#include "core/camera.h"
#include "geometry/quaternion.h"
#include "host/file_bytes.h"
#include "host/grow.h"
#include "host/reason.h"
#include "import/camera_list.h"
#include "import/folders/transforms_json.h"
#include "import/poses/pose_list.h"
#include "mcap/reader_limits.h"

#define MAX_POSES_BYTES ((size_t)16 << 20) /* a single pose is parsed twice and printed between */

void viewpoint_list_free(viewpoint_list *list)
{
    free(list->items);
    *list = (viewpoint_list){0};
}

/* Converts a finite double to fixed point; saturates, so that t3r_camera_check() refuses it. */
static int32_t to_q(double value, int fraction_bits)
{
    double scaled = nearbyint(ldexp(value, fraction_bits));
    return scaled >= INT32_MAX ? INT32_MAX : scaled <= INT32_MIN ? INT32_MIN : (int32_t)scaled;
}

int viewpoint_place(t3r_camera *camera, const rigid *pose)
{
    for (int i = 0; i < 3; i++) {
        if (!(fabs(pose->position[i]) < 1 << T3R_LIMIT_POSITION_LOG2)) {
            return -1;
        }
        camera->position_q32[i] = (int64_t)nearbyint(ldexp(pose->position[i], 32));
    }
    const double norm = quaternion_norm(pose->rotation);
    if (!(norm > 1e-6) || !isfinite(norm)) {
        return -1;
    }
    for (int i = 0; i < 4; i++) {
        camera->rotation_q30[i] = to_q(pose->rotation[i] / norm, 30);
    }
    return t3r_camera_check(camera, camera->width, camera->height) == T3R_OK ? 0 : -1;
}

/* ---- pose files --------------------------------------------------------------------------------------------- */

/* Returns 0, or -1 with a reason why the frame gives no view. width, height: as for viewpoint_read_pose(). */
static int convert_frame(const posed_frame *frame, uint32_t width, uint32_t height, t3r_camera *view, char *error,
                         size_t error_bytes)
{
    const posed_intrinsics *lens = &frame->intrinsics;
    t3r_recorded_camera camera;
    if (frame->rejected) {
        return t3r_reason(error, error_bytes, "%s", frame->wrong != NULL ? frame->wrong : "out of memory");
    }
    const bool sized = !isnan(lens->width) && !isnan(lens->height);
    if (!sized && width == 0) {
        return t3r_reason(error, error_bytes, "w or h: missing, and no --size");
    }
    if (sized && (lens->width > T3R_MAX_SIDE || lens->height > T3R_MAX_SIDE)) {
        return t3r_reason(error, error_bytes, "w, h: more than %u pixels", T3R_MAX_SIDE);
    }
    if (posed_frame_camera(frame, sized ? (uint32_t)lens->width : width, sized ? (uint32_t)lens->height : height,
                           &camera, error, error_bytes) != 0) {
        return -1;
    }
    if (camera.distortion != T3R_DISTORTION_NONE) {
        return t3r_reason(error, error_bytes,
                          "k1 ..: pictures are drawn by pinhole cameras; without distortion coefficients and a "
                          "fisheye's camera_model this pose is one");
    }
    *view = (t3r_camera){.width = camera.width, .height = camera.height};
    view->fx_q16 = to_q(camera.fx, 16);
    view->fy_q16 = to_q(camera.fy, 16);
    view->cx_q16 = to_q(camera.cx, 16);
    view->cy_q16 = to_q(camera.cy, 16);
    return viewpoint_place(view, &frame->pose) == 0
               ? 0
               : t3r_reason(error, error_bytes,
                            "the camera is out of range (focal length 8..16384 pixels, position below 2^30)");
}

static int convert_frames(const posed_folder *folder, uint32_t width, uint32_t height, viewpoint_list *out, char *error,
                          size_t error_bytes)
{
    out->items = calloc((size_t)folder->frame_count + 1, sizeof *out->items);
    if (out->items == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    for (uint32_t i = 0; i < folder->frame_count; i++) {
        char wrong[192] = "";
        if (convert_frame(&folder->frames[i], width, height, &out->items[out->count], wrong, sizeof wrong) == 0) {
            out->count++;
        } else if (folder->frame_count == 1) {
            return t3r_reason(error, error_bytes, "%s", wrong);
        } else {
            pose_losses_add(&out->losses, 1, "frames[%u]: %s", i, wrong);
        }
    }
    return out->count > 0 ? 0 : t3r_reason(error, error_bytes, "%s", out->losses.first);
}

/* Returns the text of a transforms.json around a single pose, which it takes, so that one reader checks both. */
static char *wrap_pose(cJSON *pose)
{
    cJSON *root = cJSON_CreateObject();
    cJSON *frames = cJSON_AddArrayToObject(root, "frames");
    cJSON_DeleteItemFromObjectCaseSensitive(pose, "file_path");
    cJSON_DeleteItemFromObjectCaseSensitive(pose, "depth_path");
    cJSON_AddStringToObject(pose, "file_path", "view");
    cJSON_AddItemToArray(frames, pose);
    char *wrapped = cJSON_PrintUnformatted(root);
    cJSON_Delete(root);
    return wrapped;
}

/* Reads the cameras of any of the files. */
static int read_cameras(const char *text, size_t bytes, posed_folder *out, double *rate, char *error,
                        size_t error_bytes)
{
    char *wrapped = NULL;
    *rate = 0;
    cJSON *root = json_parse_python(text, bytes, NULL, 0);
    if (root != NULL && camera_list_is(root)) {
        const int status = camera_list_read(root, out, rate, error, error_bytes);
        cJSON_Delete(root);
        return status;
    }
    if (cJSON_IsObject(root) && cJSON_GetObjectItemCaseSensitive(root, "frames") == NULL) {
        wrapped = wrap_pose(root);
        root = NULL;
    }
    cJSON_Delete(root);
    const int status = transforms_json_parse(wrapped != NULL ? wrapped : text,
                                             wrapped != NULL ? strlen(wrapped) : bytes, NULL, out, error, error_bytes);
    cJSON_free(wrapped);
    return status;
}

int viewpoint_read_pose(const char *path, uint32_t width, uint32_t height, viewpoint_list *out, char *error,
                        size_t error_bytes)
{
    *out = (viewpoint_list){0};
    size_t count;
    uint8_t *bytes = t3r_file_bytes(path, MAX_POSES_BYTES, &count, error, error_bytes);
    if (bytes == NULL) {
        return -1;
    }
    char reason[384] = "";
    posed_folder folder;
    int result = read_cameras((const char *)bytes, count, &folder, &out->rate, reason, sizeof reason);
    if (result == 0) {
        result = convert_frames(&folder, width, height, out, reason, sizeof reason);
    }
    posed_folder_close(&folder);
    free(bytes);
    if (result != 0) {
        viewpoint_list_free(out);
        t3r_reason(error, error_bytes, "%s: %s", path, reason);
    }
    return result;
}

/* ---- trajectories --------------------------------------------------------------------------------------------- */

/* Returns NULL, or what is wrong. */
static const char *read_list(pose_list *list, const t3r_camera *lens, viewpoint_list *out)
{
    size_t room = 0;
    for (pose_list_item item; pose_list_next(list, &item);) {
        t3r_camera *grown = t3r_grow(out->items, out->count, &room, sizeof *grown);
        if (grown == NULL) {
            return "out of memory";
        }
        out->items = grown;
        out->items[out->count] = *lens;
        if (viewpoint_place(&out->items[out->count], &item.pose) != 0) {
            return "the camera is out of range";
        }
        out->count++;
    }
    return NULL;
}

int viewpoint_read_trajectory(const char *path, const t3r_camera *lens, viewpoint_list *out, char *error,
                              size_t error_bytes)
{
    *out = (viewpoint_list){0};
    size_t count;
    char *text = (char *)t3r_file_bytes(path, T3R_LIMIT_TEXT_BYTES, &count, error, error_bytes);
    if (text == NULL) {
        return -1;
    }
    pose_list list = {.rest = text};
    const char *wrong = read_list(&list, lens, out);
    const int status = wrong == NULL ? pose_list_end(&list, path, error, error_bytes)
                                     : t3r_reason(error, error_bytes, "%s: line %zu: %s", path, list.line, wrong);
    free(text);
    if (status != 0) {
        viewpoint_list_free(out);
    }
    out->losses = list.losses;
    return status;
}

/* ---- turntables ----------------------------------------------------------------------------------------------- */

/* Returns the pose after a turn by an angle about the axis through `centre`. */
static rigid turned(const rigid *pose, const double centre[3], const double axis[3], double angle)
{
    rigid turn = {{0, 0, 0},
                  {cos(angle / 2), sin(angle / 2) * axis[0], sin(angle / 2) * axis[1], sin(angle / 2) * axis[2]}};
    quaternion_rotate(turn.rotation, centre, turn.position);
    for (int i = 0; i < 3; i++) {
        turn.position[i] = centre[i] - turn.position[i];
    }
    return rigid_compose(&turn, pose);
}

/* Returns the angle of a view of a whole turn, or of an arc in degrees. */
static double angle_of(uint32_t index, uint32_t count, double arc)
{
    return arc > 0 ? (count > 1 ? arc * M_PI / 180 * ((double)index / (count - 1) - 0.5) : 0)
                   : 2 * M_PI * index / count;
}

int viewpoint_turn(const t3r_camera *start, const double centre[3], const double axis[3], uint32_t count, double arc,
                   viewpoint_list *out, char *error, size_t error_bytes)
{
    *out = (viewpoint_list){.items = calloc(count, sizeof *out->items)};
    if (out->items == NULL) {
        return t3r_reason(error, error_bytes, "out of memory");
    }
    rigid pose;
    for (int i = 0; i < 3; i++) {
        pose.position[i] = ldexp((double)start->position_q32[i], -32);
    }
    for (int i = 0; i < 4; i++) {
        pose.rotation[i] = ldexp(start->rotation_q30[i], -30);
    }
    for (; out->count < count; out->count++) {
        const double angle = angle_of(out->count, count, arc);
        const rigid view = turned(&pose, centre, axis, angle);
        out->items[out->count] = *start;
        if (angle != 0 && viewpoint_place(&out->items[out->count], &view) != 0) {
            viewpoint_list_free(out);
            return t3r_reason(error, error_bytes, "a view is out of range: positions are below 2^30");
        }
    }
    return 0;
}
