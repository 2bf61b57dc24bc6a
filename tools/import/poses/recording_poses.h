/* Poses of a recording's frames from what they show, in the place of those that it holds. */
#ifndef TRIM3R_TOOLS_RECORDING_POSES_H
#define TRIM3R_TOOLS_RECORDING_POSES_H

#include "posing/estimate.h"
#include "recording/recording.h"

/* Estimates the poses of `count` frames and sets them in the recording, rounded to the fixed point of t3r_camera, so
 * that all that reads these frames later sees the same numbers. The first that can be posed keeps its recorded pose;
 * without one it is the world's origin. accounts[] (`count`): what each rests on, `from` being an index into frames[];
 * a frame whose account has no pose keeps what it had. An exit status of cli.h. */
int recording_estimate_poses(t3r_recording *recording, const char *path, const uint32_t *frames, uint32_t count,
                             poses_source source, pose_account *accounts);

/* The same for all views of a scene: one that gets no pose is an error, as a scene of the others would not be the one
 * that was asked for. */
int recording_pose_views(t3r_recording *recording, const char *path, const uint32_t *frames, uint32_t count,
                         poses_source source, pose_account *accounts);

#endif
