/* SPDX-License-Identifier: Apache-2.0 */
/* Chooses the frames of a recording that together see most of the scene, sharply and from different places. */
#ifndef TRIM3R_TOOLS_CONTEXT_CHOICE_H
#define TRIM3R_TOOLS_CONTEXT_CHOICE_H

#include <stdint.h>

#include "recording/recording.h"
#include "trim3r.h"

/* Chooses 1 to T3R_MAX_VIEWS frames, or 2 and more for T3R_DEPTH_STEREO, in ascending order into frames[]: of at most
 * CONTEXT_CANDIDATES frames with pose, intrinsics and the depth that is needed, spread evenly, and never `except`. The
 * next frame is always the one that adds most: surface that no chosen frame sees from a like direction, or by
 * stereo none from another place; a blurred frame counts for less. The choice ends where a frame adds little.
 * Deterministic. Returns an exit status of cli.h. */
int context_choose(const t3r_recording *recording, const char *path, t3r_depth depth, uint32_t except,
                   uint32_t frames[T3R_MAX_VIEWS], uint32_t *count);

#define CONTEXT_CANDIDATES 128u

#endif
