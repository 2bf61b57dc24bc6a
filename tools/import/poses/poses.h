/* Poses of a folder's frames from what their pictures show. */
#ifndef TRIM3R_TOOLS_IMPORT_POSES_H
#define TRIM3R_TOOLS_IMPORT_POSES_H

#include "import/folders/posed_frame.h"
#include "posing/estimate.h"

/* Estimates the poses of the frames that can be posed, from pictures of their own size, and puts them into the folder
 * as the numbers that a recording's reader rounds to exactly these: positions in steps of 2^-32, quaternions of 2^-30.
 * The first of them keeps its pose; without one it is the origin. The others have no pose from then on. accounts[]: one
 * a frame. 0, or with a reason in error[] what import_frame() answered, else -1. */
int import_estimate_poses(const char *directory, posed_folder *folder, poses_source source, pose_account *accounts,
                          char *error, size_t error_bytes);

#endif
