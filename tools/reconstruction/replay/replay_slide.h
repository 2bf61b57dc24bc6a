/* Replays a sliding pair: a scene of every two consecutive frames, all stages hashed. */
#ifndef TRIM3R_TOOLS_REPLAY_SLIDE_H
#define TRIM3R_TOOLS_REPLAY_SLIDE_H

#include <stdbool.h>

#include "reconstruction/reconstruction.h"
#include "recording/recording.h"
#include "reconstruction/replay/replay_expectation.h"

/* Builds the first scene from frames 0 and 1, and one from each later frame and its predecessor, in the same arena.
 * With config.warm a build continues the previous one. A budget in percent refers to the first pair's points. Returns
 * an exit status of cli.h. */
int replay_slide(const t3r_recording *recording, const char *path, const reconstruction_options *settings, bool json,
                 const expectation *e);

#endif
