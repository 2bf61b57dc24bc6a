/* SPDX-License-Identifier: Apache-2.0 */
#include "import/estimation/poses_output.h"

#include <inttypes.h>
#include <math.h>
#include <stdio.h>

#include "cli/text/wrapped.h"

cJSON *pose_account_json(const uint32_t *frames, uint32_t index, const pose_account *accounts)
{
    const pose_account *a = &accounts[index];
    cJSON *out = cJSON_CreateObject();
    cJSON_AddNumberToObject(out, "frame", frames != NULL ? frames[index] : index);
    if (a->why[0] != '\0') {
        cJSON_AddStringToObject(out, "why", a->why);
    }
    if (a->matches > 0) {
        cJSON_AddNumberToObject(out, "from", frames != NULL ? frames[a->from] : a->from);
        cJSON_AddNumberToObject(out, "matches", a->matches);
        cJSON_AddNumberToObject(out, "tried", a->tried);
        cJSON_AddBoolToObject(out, "by_depth", a->metric);
        cJSON_AddNumberToObject(out, "pixels", a->pixels);
        cJSON_AddNumberToObject(out, "rotation_degrees", a->turn_degrees);
        cJSON_AddNumberToObject(out, "direction_degrees", a->direction_degrees);
    }
    return out;
}

void pose_add_json(cJSON *object, const t3r_camera *camera)
{
    cJSON *position = cJSON_AddArrayToObject(object, "position"),
          *rotation = cJSON_AddArrayToObject(object, "rotation");
    for (int k = 0; k < 3; k++) {
        cJSON_AddItemToArray(position, cJSON_CreateNumber(ldexp((double)camera->position_q32[k], -32)));
    }
    for (int k = 0; k < 4; k++) {
        cJSON_AddItemToArray(rotation, cJSON_CreateNumber(ldexp(camera->rotation_q30[k], -30)));
    }
}

void poses_add_json(cJSON *object, const t3r_recording *recording, const uint32_t *frames, uint32_t count,
                    const pose_account *accounts)
{
    cJSON *poses = cJSON_AddArrayToObject(object, "poses");
    for (uint32_t i = 0; i < count; i++) {
        cJSON *one = pose_account_json(frames, i, accounts);
        t3r_capture_frame frame;
        char error[64];
        if (t3r_recording_frame(recording, frames[i], &frame, error, sizeof error) == T3R_CAPTURE_FRAME) {
            pose_add_json(one, &frame.camera);
        }
        cJSON_AddItemToArray(poses, one);
    }
}

void poses_print(const uint32_t *frames, uint32_t count, const pose_account *accounts)
{
    for (uint32_t i = 0; i < count; i++) {
        const pose_account *a = &accounts[i];
        char why[512];
        if (a->why[0] != '\0') {
            (void)pose_refusal(accounts, i, frames, why, sizeof why);
            wrapped_print(stdout, 0, "", why);
        } else if (a->matches > 0) {
            wrapped_printf(2, "frame ",
                           "%" PRIu32 " posed from frame %" PRIu32 ": %" PRIu32 " of %" PRIu32
                           " features agree within %.2f pixels%s, rotation +-%.2f degrees, direction +-%.1f",
                           frames != NULL ? frames[i] : i, frames != NULL ? frames[a->from] : a->from, a->matches,
                           a->tried, a->pixels, a->metric ? ", by depth" : "", a->turn_degrees, a->direction_degrees);
        }
    }
}
