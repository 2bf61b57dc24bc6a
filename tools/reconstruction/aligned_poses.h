/* SPDX-License-Identifier: Apache-2.0 */
/* Measures how far a build moved the poses of its context views (`align`). */
#ifndef TRIM3R_TOOLS_ALIGNED_POSES_H
#define TRIM3R_TOOLS_ALIGNED_POSES_H

#include <cjson/cJSON.h>

#include "reconstruction/reconstruction.h"
#include "recording/recording.h"

typedef struct pose_correction {
    double degrees;  /* angle between the given pose and the one that the build used, 0..180 */
    double distance; /* distance between their centres, in the recording's unit */
} pose_correction;

/* Computes a correction per context view; all zero if the scene has no views. Returns an exit status of cli.h. */
int aligned_poses_of(const t3r_recording *recording, const char *path, const reconstruction_account *account,
                     pose_correction corrections[T3R_MAX_VIEWS]);

/* Adds "aligned": one object per view with the correction and the pose that the build used. Nothing if the scene has
 * no views. */
void aligned_poses_add_json(cJSON *object, const reconstruction_account *account, const pose_correction *corrections);
/* Prints a line on stdout for each view whose pose was corrected. */
void aligned_poses_print(const reconstruction_account *account, const pose_correction *corrections);

#endif
