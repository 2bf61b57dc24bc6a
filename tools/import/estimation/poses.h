/* SPDX-License-Identifier: Apache-2.0 */
/* Estimates the poses of a folder's frames from their pictures. */
#ifndef TRIM3R_TOOLS_IMPORT_POSES_H
#define TRIM3R_TOOLS_IMPORT_POSES_H

#include "import/frames/posed_frame.h"
#include "posing/estimate.h"

/* Estimates the poses of the frames from pictures of their own size, or of width x height (0: not given) where that is
 * too large for a frame, and stores them in the folder as numbers that a
 * recording's reader rounds to exactly these: positions in steps of 2^-32, quaternions of 2^-30. The first frame that
 * can be posed keeps its pose; without one it is the origin. Frames that cannot be posed lose theirs. accounts[]: one
 * per frame. Focal lengths that the folder does not give are taken from EXIF, or estimated. Returns 0; with a reason in
 * error[], the status of import_frame(), else -1. */
int import_estimate_poses(const char *directory, posed_folder *folder, uint32_t width, uint32_t height,
                          poses_source source, pose_account *accounts, char *error, size_t error_bytes);

#endif
