/* How far a build moved the poses of its context views (`align`). */
#ifndef TRIM3R_TOOLS_ALIGNED_POSES_H
#define TRIM3R_TOOLS_ALIGNED_POSES_H

#include <cjson/cJSON.h>

#include "reconstruction/reconstruction.h"
#include "recording/recording.h"

typedef struct pose_correction {
    double degrees;  /* of the rotation between the pose given and the one built with, 0..180 */
    double distance; /* between their centres, in the recording's unit */
} pose_correction;

/* A correction a context view; all zero where the scene has no views of its own. An exit status of cli.h. */
int aligned_poses_of(const t3r_recording *recording, const char *path, const reconstruction_account *told,
                     pose_correction corrections[T3R_MAX_VIEWS]);

/* "aligned": one object a view: the correction, and the pose built with. Nothing where the scene has no views. */
void aligned_poses_add_json(cJSON *object, const reconstruction_account *told, const pose_correction *corrections);
/* A line on stdout for each view whose pose was corrected. */
void aligned_poses_print(const reconstruction_account *told, const pose_correction *corrections);

#endif
