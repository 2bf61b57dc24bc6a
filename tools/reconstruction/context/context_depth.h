/* SPDX-License-Identifier: Apache-2.0 */
/* The depth of a scene by stereo, for a choice of frames that have none. */
#ifndef TRIM3R_TOOLS_CONTEXT_DEPTH_H
#define TRIM3R_TOOLS_CONTEXT_DEPTH_H

#include <stdint.h>

#include "reconstruction/context/view_surface.h"
#include "recording/recording.h"

/* Measures the scene's depth by stereo of frames a and b, in a small and coarse scene. first: the surface of frame a.
 * Returns the median in world units before frame a; 0 if they give none, with a message of cli_error(). */
double context_depth_of_pair(const t3r_recording *recording, const char *path, const view_surface *first, uint32_t a,
                             uint32_t b);

#endif
