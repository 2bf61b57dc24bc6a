/* SPDX-License-Identifier: Apache-2.0 */
/* Estimates poses of a recording's frames from their pictures, replacing its own. */
#ifndef TRIM3R_TOOLS_RECORDING_POSES_H
#define TRIM3R_TOOLS_RECORDING_POSES_H

#include "posing/estimate.h"
#include "recording/recording.h"

/* Estimates the poses of `count` frames and sets them in the recording, rounded to the fixed point of t3r_camera, so
 * that later readers of these frames see the same numbers. The first frame that can be posed keeps its recorded pose;
 * without one it is the world's origin. accounts[] (`count`): what each pose is based on, `from` being an index into
 * frames[]; a frame whose account has no pose keeps what it had. Returns an exit status of cli.h. */
int recording_estimate_poses(t3r_recording *recording, const char *path, const uint32_t *frames, uint32_t count,
                             poses_source source, pose_account *accounts);

/* The same for all views of a scene. A view that gets no pose is an error, since a scene without it would not be the
 * requested one. */
int recording_pose_views(t3r_recording *recording, const char *path, const uint32_t *frames, uint32_t count,
                         poses_source source, pose_account *accounts);

#endif
