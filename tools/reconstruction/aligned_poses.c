/* SPDX-License-Identifier: Apache-2.0 */
#include "reconstruction/aligned_poses.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

#include "cli/cli.h"
#include "cli/files/recorded_frame.h"
#include "geometry/quaternion.h"
#include "import/estimation/poses_output.h"

/* Returns the angle of the rotation from one quaternion to the other. It uses the vector part of their quotient, which,
 * unlike the scalar part, keeps small angles exact. */
static double degrees_between(const int32_t a_q30[4], const int32_t b_q30[4])
{
    if (memcmp(a_q30, b_q30, 4 * sizeof a_q30[0]) == 0) {
        return 0; /* the quotient would be off by its rounding */
    }
    double back[4], b[4], quotient[4];
    for (int i = 0; i < 4; i++) {
        back[i] = i == 0 ? a_q30[i] : -(double)a_q30[i];
        b[i] = b_q30[i];
    }
    quaternion_multiply(back, b, quotient);
    const double *v = quotient + 1;
    return 2 * atan2(sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]), fabs(quotient[0])) * 180 / acos(-1);
}

static double distance_between(const int64_t a_q32[3], const int64_t b_q32[3])
{
    double squared = 0;
    for (int i = 0; i < 3; i++) {
        const double difference = ldexp((double)(a_q32[i] - b_q32[i]), -32);
        squared += difference * difference;
    }
    return sqrt(squared);
}

int aligned_poses_of(const t3r_recording *recording, const char *path, const reconstruction_account *account,
                     pose_correction corrections[T3R_MAX_VIEWS])
{
    for (uint32_t v = 0; v < account->context_count; v++) {
        t3r_capture_frame frame;
        const int code = recorded_frame_read(recording, path, account->context[v], &frame);
        if (code != CLI_OK) {
            return code;
        }
        const t3r_camera *given = &frame.camera, *built = &account->camera[v];
        corrections[v] = (pose_correction){0};
        if (account->has_cameras) {
            corrections[v].degrees = degrees_between(given->rotation_q30, built->rotation_q30);
            corrections[v].distance = distance_between(given->position_q32, built->position_q32);
        }
    }
    return CLI_OK;
}

void aligned_poses_add_json(cJSON *object, const reconstruction_account *account, const pose_correction *corrections)
{
    cJSON *list = account->has_cameras ? cJSON_AddArrayToObject(object, "aligned") : NULL;
    for (uint32_t v = 0; v < account->context_count && list != NULL; v++) {
        cJSON *one = cJSON_CreateObject();
        cJSON_AddNumberToObject(one, "frame", account->context[v]);
        cJSON_AddNumberToObject(one, "degrees", corrections[v].degrees);
        cJSON_AddNumberToObject(one, "distance", corrections[v].distance);
        pose_add_json(one, &account->camera[v]);
        cJSON_AddItemToArray(list, one);
    }
}

void aligned_poses_print(const reconstruction_account *account, const pose_correction *corrections)
{
    for (uint32_t v = 0; v < account->context_count; v++) {
        if (corrections[v].degrees > 0 || corrections[v].distance > 0) {
            printf("pose of frame %" PRIu32 " corrected by %.2f degrees and %.4f units\n", account->context[v],
                   corrections[v].degrees, corrections[v].distance);
        }
    }
}
