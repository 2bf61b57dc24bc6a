/* SPDX-License-Identifier: Apache-2.0 */
/* Reports on poses. */
#ifndef TRIM3R_TOOLS_POSES_OUTPUT_H
#define TRIM3R_TOOLS_POSES_OUTPUT_H

#include <cjson/cJSON.h>

#include "posing/estimate.h"
#include "recording/recording.h"

/* Adds "position", in the recording's unit, and "rotation", a quaternion w x y z: exact. */
void pose_add_json(cJSON *object, const t3r_camera *camera);
/* Adds "poses": one object per frame, with what it is based on, and the exact pose that the recording now has. */
void poses_add_json(cJSON *object, const t3r_recording *recording, const uint32_t *frames, uint32_t count,
                    const pose_account *accounts);
/* Prints a line per frame on stdout. frames: their numbers; NULL: 0, 1 ... */
void poses_print(const uint32_t *frames, uint32_t count, const pose_account *accounts);
/* Returns only the account, for one frame of poses_add_json(). */
cJSON *pose_account_json(const uint32_t *frames, uint32_t index, const pose_account *accounts);

#endif
