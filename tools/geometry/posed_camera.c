/* SPDX-License-Identifier: Apache-2.0 */
/* Poses of cameras for programs of the host library. */
#include <string.h>

#include "geometry/pose_check.h"
#include "geometry/pose_matrix.h"
#include "geometry/quaternion.h"
#include "host/program_check.h"
#include "host/reason.h"

static t3r_status refuse(const char *wrong, char *error, size_t error_bytes)
{
    t3r_reason(error, error_bytes, "the pose: %s", wrong);
    return T3R_ERR_CAMERA;
}

/* Sets the pose of the camera from one in a convention. */
static t3r_status set_pose(t3r_recorded_camera *camera, const rigid *pose, uint32_t axes, char *error,
                           size_t error_bytes)
{
    if (axes > (T3R_AXES_OPENGL | T3R_WORLD_TO_CAMERA)) {
        return refuse("axes are a sum of t3r_axes", error, error_bytes);
    }
    const rigid out = pose_of_convention(pose, axes);
    const char *wrong = pose_check(&out);
    if (wrong != NULL) {
        return refuse(wrong, error, error_bytes);
    }
    memcpy(camera->position, out.position, sizeof camera->position);
    memcpy(camera->rotation, out.rotation, sizeof camera->rotation);
    t3r_reason(error, error_bytes, "%s", "");
    return T3R_OK;
}

t3r_status t3r_camera_pose_matrix_as(t3r_program program, t3r_recorded_camera *camera, const double matrix[16],
                                     uint32_t axes, char *error, size_t error_bytes)
{
    rigid pose;
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    const char *wrong = pose_of_matrix(matrix, T3R_AXES_OPENCV, &pose);
    return wrong != NULL ? refuse(wrong, error, error_bytes) : set_pose(camera, &pose, axes, error, error_bytes);
}

t3r_status t3r_camera_pose_quaternion_as(t3r_program program, t3r_recorded_camera *camera, const double translation[3],
                                         const double rotation[4], uint32_t axes, char *error, size_t error_bytes)
{
    rigid pose;
    if (!t3r_program_fits(program, t3r_host_program(), error, error_bytes)) {
        return T3R_ERR_INTERFACE;
    }
    memcpy(pose.position, translation, sizeof pose.position);
    memcpy(pose.rotation, rotation, sizeof pose.rotation);
    const char *wrong = pose_check(&pose);
    if (wrong != NULL) {
        return refuse(wrong, error, error_bytes);
    }
    quaternion_normalise(pose.rotation);
    return set_pose(camera, &pose, axes, error, error_bytes);
}
