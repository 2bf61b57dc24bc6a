/* Replay of a pair that slides: a scene of every two frames that follow one another, all stages hashed. */
#ifndef TRIM3R_TOOLS_REPLAY_SLIDE_H
#define TRIM3R_TOOLS_REPLAY_SLIDE_H

#include <stdbool.h>

#include "reconstruction/reconstruction.h"
#include "recording/recording.h"
#include "reconstruction/replay/replay_expectation.h"

/* Frames 0 and 1 make the first scene, and each later one makes one with the frame before, in the same arena. With
 * config.warm a build follows the one before. A budget in percent is of the first pair's points. An exit status of
 * cli.h. */
int replay_slide(const t3r_recording *recording, const char *path, const reconstruction_options *settings, bool json,
                 const expectation *e);

#endif
