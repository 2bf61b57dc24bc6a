/* `trim3r replay --stream`: a recording's frames in turn, keyframes into one bounded map, the others held back. */
#ifndef TRIM3R_TOOLS_REPLAY_STREAM_H
#define TRIM3R_TOOLS_REPLAY_STREAM_H

#include <stdint.h>

#include "reconstruction/reconstruction.h"
#include "recording/recording.h"
#include "reconstruction/replay/replay_expectation.h"

#define REPLAY_STREAM_EVERY 3u
#define REPLAY_STREAM_AT_HAND 4u

typedef struct replay_stream_options {
    uint32_t every; /* frames from keyframe to keyframe; 0 = REPLAY_STREAM_EVERY */
    uint32_t
        overlap_q8; /* where not 0: a frame is a keyframe when it has less in common with the last, or `every` is up */
    uint32_t at_hand;   /* keyframes whose planes are kept; 0 = REPLAY_STREAM_AT_HAND */
    const char *images; /* folder for the views drawn; NULL = none */
    const char *output; /* scene file for the map as it is in the end; NULL = none */
    bool json;
} replay_stream_options;

/* Frames 0, every, 2 every ... are keyframes, or more of them by overlap_q8. A frame between two is drawn when the
 * later one has been taken, and all of them once more from the map in the end, which is then
 * written. An exit status of cli.h. */
int replay_stream(const replay_stream_options *options, const t3r_recording *recording, const char *path,
                  const reconstruction_options *settings, const expectation *e);

#endif
