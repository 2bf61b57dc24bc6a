/* SPDX-License-Identifier: Apache-2.0 */
/* The frames of a recording that a scene is made of. */
#ifndef TRIM3R_TOOLS_CONTEXT_FRAMES_H
#define TRIM3R_TOOLS_CONTEXT_FRAMES_H

#include <stdint.h>

#include "reconstruction/reconstruction.h"

#define CONTEXT_NO_FRAME UINT32_MAX

/* Lists the frames that the options ask for: those that they list, else the first two; all; or those that
 * context_choose() chooses. All and chosen frames leave out the frame `except` (CONTEXT_NO_FRAME: none). Returns an
 * exit status of cli.h. */
int context_frames(const t3r_recording *recording, const char *path, const reconstruction_options *options,
                   uint32_t except, uint32_t frames[T3R_MAX_VIEWS], uint32_t *count);

/* Replaces a choice in the options by the list of frames, likewise. */
int context_resolve(reconstruction_options *options, const t3r_recording *recording, const char *path);

/* Warns on stderr of each context frame with depth of whose surface every other one sees little: the scene shows two
 * places that nothing holds together. Frames that cannot be read are left to the build. */
void context_warn_of_strangers(const t3r_recording *recording, const char *path, const reconstruction_options *options);

#endif
